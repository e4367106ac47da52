"""OpenCASCADE reads every BREP file as it is: valid, shared, same parameters everywhere, fast."""

from __future__ import annotations

import json
import time
from pathlib import Path

import pytest
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.BRepTools import BRepTools
from OCP.GeomAbs import GeomAbs_SurfaceType
from OCP.GProp import GProp_GProps
from OCP.STEPControl import STEPControl_Reader
from OCP.TopoDS import TopoDS, TopoDS_Shape

import cli
import close
import edits
import measure
import topology
from occ import sub_shapes

#: Times as long as a BREP file, that a STEP file must take to read at the least.
FASTER = 5


def read(path: Path) -> TopoDS_Shape:
    shape = TopoDS_Shape()
    assert BRepTools.Read_s(shape, str(path), BRep_Builder()), path.name
    return shape


@pytest.fixture(scope="session")
def shapes(model) -> dict[str, TopoDS_Shape]:
    return {part: read(model.file(part, "brep")) for part in (*model.parts, "assembly")}


def test_valid(shapes):
    for part, shape in shapes.items():
        assert topology.faults(shape) == [], part


def test_a_solid_a_solid(model, shapes):
    for part in model.parts:
        assert len(sub_shapes(shapes[part], topology.SOLID)) == len(model.solids(part))
    assert len(sub_shapes(shapes["assembly"], topology.SOLID)) == len(model.report["solids"])


def test_closed_with_the_genus_of_the_design(model, shapes):
    for part in model.parts:
        for solid, name in zip(sub_shapes(shapes[part], topology.SOLID), model.in_order(part), strict=True):
            assert topology.free_edges(solid) == 0, name
            assert topology.genus(solid) == model.report["genus"][name]["expected"], name


def test_faces_are_shared(model, shapes):
    """Each face of the model is one of the shape, however many solids it bounds, in their order."""
    names: list[str] = []
    for solid in model.manifest["solids"]:
        names += [name for name in solid["faces"] if name not in names]
    faces = sub_shapes(shapes["assembly"], topology.FACE)
    places = {face["name"]: face for face in model.manifest["faces"]}
    for face, name in zip(faces, names, strict=True):
        found = GProp_GProps()
        BRepGProp.SurfaceProperties_s(face, found, 1e-6)
        centre = found.CentreOfMass()
        assert close.relative(found.Mass(), places[name]["area_mm2"]) <= 1e-3, name
        assert [centre.X(), centre.Y(), centre.Z()] == pytest.approx(places[name]["centroid_mm"], abs=0.02), (
            name
        )


def test_same_parameter_and_tight(shapes):
    for part, shape in shapes.items():
        assert all(BRep_Tool.SameParameter_s(edge) for edge in topology.edges(shape)), part
        assert topology.greatest_tolerance(shape) <= 1e-7, part


def test_volume(model, shapes):
    for part in model.parts:
        for solid, name in zip(sub_shapes(shapes[part], topology.SOLID), model.in_order(part), strict=True):
            expected = model.report["solids"][name]["volume_mm3"]
            close.assert_volume(measure.volume_adaptive(solid), expected, name)


def seconds(action) -> float:
    started = time.process_time()
    action()
    return time.process_time() - started


def test_read_faster_than_step(model):
    """The greatest file of the sample; small ones are too quick to tell."""
    part = max(model.parts, key=lambda part: model.file(part, "step").stat().st_size)

    def step() -> None:
        reader = STEPControl_Reader()
        reader.ReadFile(str(model.file(part, "step")))
        reader.TransferRoots()

    brep = min(seconds(lambda: read(model.file(part, "brep"))) for _ in range(3))
    assert seconds(step) >= FASTER * brep


@pytest.mark.parametrize(
    "ends", [[249.4, 253, 301.5, 318], [250.5, 250.5, 310, 310]], ids=["cone", "cylinder"]
)
def test_straight_hubs_are_cones_and_cylinders(ends, tmp_path):
    """No sample has them; OpenCASCADE measures cones along their sides, STEP along the axis."""
    design = json.loads((cli.SAMPLES / "rotor.json").read_text(encoding="utf-8"))
    hub, shroud = ([[-15, first], [75, last]] for first, last in (ends[:2], ends[2:]))
    path = edits.write(
        tmp_path / "design.json", edits.edited(design, {"/space/hub": hub, "/space/shroud": shroud})
    )
    done = cli.run("generate", path, "--out", tmp_path, "--format", "brep")
    assert done.returncode == cli.DONE, done.stderr
    model = cli.Model(path, tmp_path)
    shape = read(model.file("assembly", "brep"))
    assert BRepCheck_Analyzer(shape).IsValid()
    kinds = {BRepAdaptor_Surface(TopoDS.Face(face)).GetType() for face in sub_shapes(shape, topology.FACE)}
    assert kinds & {GeomAbs_SurfaceType.GeomAbs_Cone, GeomAbs_SurfaceType.GeomAbs_Cylinder}
    volumes = [measure.volume_adaptive(solid) for solid in sub_shapes(shape, topology.SOLID)]
    close.assert_volume(sum(volumes), model.report["blank"]["volume_mm3"], "sum of solids")
