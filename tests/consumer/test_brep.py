"""OpenCASCADE reads every BREP file as it is: valid, shared, same parameters everywhere, fast."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepGProp import BRepGProp
from OCP.BRepTools import BRepTools
from OCP.GProp import GProp_GProps
from OCP.STEPControl import STEPControl_Reader
from OCP.TopoDS import TopoDS_Shape

import close
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
