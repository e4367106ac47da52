"""The NASA C3X vane against its published figures (NASA CR-168015), through OpenCASCADE and the report."""

from __future__ import annotations

import math

import pytest
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.BRepGProp import BRepGProp
from OCP.gp import gp_Pnt
from OCP.GProp import GProp_GProps
from OCP.TopoDS import TopoDS_Compound

import cli
import close

HEIGHT = 76.2
DIAMETERS = [6.3] * 7 + [3.1] * 2 + [1.98]
CENTRES = {0: (20.75, 119.86), 9: (74.56, 5.81)}  # of the first and the last hole


@pytest.fixture(scope="module")
def vane(library) -> cli.Model:
    return library.model(cli.SAMPLES / "c3x.json")


@pytest.fixture(scope="module")
def holes(library, vane):
    """Centre and diameter of each hole, from its coolant's mass."""
    found = []
    for product in sorted(library.products(vane.file("coolant", "step")), key=lambda product: product.name):
        mass = GProp_GProps()
        BRepGProp.VolumeProperties_s(product.shape, mass, 1e-9)
        centre = mass.CentreOfMass()
        found.append((centre.X(), centre.Y(), math.sqrt(4 * mass.Mass() / HEIGHT / math.pi)))
    return found


def test_ten_holes_of_the_table(holes):
    assert [diameter for _, _, diameter in holes] == pytest.approx(DIAMETERS, rel=1e-6)


def test_first_and_last_hole_are_where_the_report_puts_them(holes):
    for number, centre in CENTRES.items():
        assert math.dist(holes[number][:2], centre) < 0.3


def test_profile_passes_through_the_table(library, vane):
    (metal,) = library.products(vane.file("metal", "step"))
    skin = TopoDS_Compound()
    builder = BRep_Builder()
    builder.MakeCompound(skin)
    for face in metal.named("blade/"):
        builder.Add(skin, face.shape)
    for x, y in vane.design["blade"]["sections"][0]["points"]:
        vertex = BRepBuilderAPI_MakeVertex(gp_Pnt(x, y, HEIGHT / 2)).Vertex()
        assert BRepExtrema_DistShapeShape(vertex, skin).Value() < 0.01, (x, y)


def test_metal_is_the_profile_less_the_holes(vane):
    holes = sum(math.pi * d * d / 4 for d in DIAMETERS)
    assert holes == pytest.approx(236.4, abs=0.05)
    expected = (vane.report["blank"]["hub_area_mm2"] - holes) * HEIGHT
    assert close.relative(vane.report["solids"]["metal"]["volume_mm3"], expected) < 1e-6


def test_thinnest_wall_is_at_the_last_hole(vane):
    wall = vane.report["wall_thickness_mm"]
    assert wall["min"] == pytest.approx(1.13, abs=0.005)
    assert wall["face"].startswith("radial_hole/10/")
