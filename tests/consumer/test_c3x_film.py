"""The C3X vane's nine film rows against the figures of NASA CR-182133, measured on the imported STEP file."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
import pytest
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepGProp import BRepGProp
from OCP.collections import HArray1_gp_Pnt
from OCP.GCPnts import GCPnts_AbscissaPoint
from OCP.Geom import Geom_BSplineCurve
from OCP.GeomAdaptor import GeomAdaptor_Curve
from OCP.GeomAPI import GeomAPI_Interpolate, GeomAPI_ProjectPointOnCurve
from OCP.gp import gp_Pnt, gp_Vec
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopoDS import TopoDS

import cli
import occ

DIAMETER, PITCH_D, HEAD_LENGTH = 0.99, 4.0, 3.35
HEAD = [f"head_{k}" for k in range(1, 6)]
PAIRS = {"pressure": 20.0, "suction": 35.0}  # inclination of the two rows of each side
HEAD_SPACING_D, PAIR_SPACING_D, SLANT, SKEW = 7.5, 3.0, 45.0, 90.0
EDGE = TopAbs_ShapeEnum.TopAbs_EDGE


@dataclass
class Hole:
    exit: np.ndarray  # where the axis meets the outer surface
    axis: np.ndarray  # unit, out of the blade
    normal: np.ndarray  # of the outer surface there
    diameter: float
    length: float


@pytest.fixture(scope="module")
def vane(library) -> cli.Model:
    return library.model(cli.SAMPLES / "c3x-film.json")


@pytest.fixture(scope="module")
def rows(library, vane) -> dict[str, list[Hole]]:
    """The holes of each row from hub to tip."""
    found: dict[str, list[tuple[str, Hole]]] = {}
    for product in library.products(vane.file("coolant", "step")):
        faces: dict[tuple[str, str], dict[str, object]] = {}
        for face in product.named("film/"):
            _, row, number, *rest = face.name.split("/")
            faces.setdefault((row, number), {})["/".join(rest)] = face.shape
        for (row, number), parts in faces.items():
            found.setdefault(row, []).append((number, hole(parts)))
    return {
        row: [h for _, h in sorted(numbered, key=lambda item: item[0])] for row, numbered in found.items()
    }


def hole(parts: dict[str, object]) -> Hole:
    """From the two half faces of the bore: their seams lie opposite one another, a diameter apart."""
    halves = [face for name, face in parts.items() if name.startswith("bore/")]
    seams = {}
    for half in halves:
        for edge in occ.sub_shapes(half, EDGE):
            curve = BRepAdaptor_Curve(TopoDS.Edge(edge))
            start, end = (point(curve.Value(t)) for t in (curve.FirstParameter(), curve.LastParameter()))
            middle = point(curve.Value(0.5 * (curve.FirstParameter() + curve.LastParameter())))
            if np.linalg.norm(middle - 0.5 * (start + end)) < 1e-9:
                seams[tuple(np.round(middle, 6))] = (start, end)
    exit_faces = [face for name, face in parts.items() if name.startswith("exit")]
    centre, normal = outward(exit_faces)
    a, b = next(iter(seams.values()))
    axis = (b - a) / np.linalg.norm(b - a)
    axis *= math.copysign(1.0, axis @ normal)

    def apart(pair) -> np.ndarray:
        """Across the axis; more than two seams are there where the bore crosses a border."""
        between = pair[1][0] - pair[0][0]
        return between - axis * (between @ axis)

    pair = max(itertools.combinations(seams.values(), 2), key=lambda pair: np.linalg.norm(apart(pair)))
    (a, b), (c, d) = pair
    across = apart(pair)
    # The axis runs halfway between the seams; it breaks out where the exit's faces are.
    middle = 0.5 * (a + c) - axis * (0.5 * (a + c) @ axis)
    lengths = [np.linalg.norm(b - a), np.linalg.norm(d - c)]
    return Hole(
        middle + axis * (centre @ axis), axis, normal, float(np.linalg.norm(across)), float(np.mean(lengths))
    )


def outward(faces) -> tuple[np.ndarray, np.ndarray]:
    """Centre and normal of the faces of an exit, out of the coolant."""
    areas, centres, normals = [], [], []
    for face in faces:
        mass = GProp_GProps()
        BRepGProp.SurfaceProperties_s(face, mass)
        surface = BRepAdaptor_Surface(face)
        u = 0.5 * (surface.FirstUParameter() + surface.LastUParameter())
        v = 0.5 * (surface.FirstVParameter() + surface.LastVParameter())
        at, du, dv = gp_Pnt(), gp_Vec(), gp_Vec()
        surface.D1(u, v, at, du, dv)
        normal = point(du.Crossed(dv))
        normal /= np.linalg.norm(normal)
        forward = face.Orientation().name.endswith("FORWARD")
        areas.append(mass.Mass())
        centres.append(point(mass.CentreOfMass()))
        normals.append(normal if forward else -normal)
    weights = np.array(areas) / sum(areas)
    normal = weights @ np.array(normals)
    return weights @ np.array(centres), normal / np.linalg.norm(normal)


def point(p) -> np.ndarray:
    return np.array([p.X(), p.Y(), p.Z()])


@pytest.fixture(scope="module")
def profile(vane) -> Geom_BSplineCurve:
    """The table's points from behind the suction side's rows round the nose to behind the others."""
    points = vane.design["blade"]["sections"][0]["points"]
    order = [points[k % len(points)] for k in range(18, -22, -1)]
    array = HArray1_gp_Pnt(1, len(order))
    for i, (x, y) in enumerate(order, start=1):
        array.SetValue(i, gp_Pnt(x, y, 0.0))
    spline = GeomAPI_Interpolate(array, False, 1e-6)
    spline.Perform()
    return spline.Curve()


def along(profile, hole: Hole) -> float:
    """Where on the profile a hole breaks out, mm."""
    foot = GeomAPI_ProjectPointOnCurve(gp_Pnt(hole.exit[0], hole.exit[1], 0.0), profile)
    assert foot.LowerDistance() < 0.05
    curve = GeomAdaptor_Curve(profile)
    return GCPnts_AbscissaPoint.Length_s(curve, curve.FirstParameter(), foot.LowerDistanceParameter(), 1e-9)


def each(rows, names) -> list[Hole]:
    return [hole for name in names for hole in rows[name]]


def test_nine_rows(rows):
    assert sorted(rows) == sorted(HEAD + [f"{side}_{k}" for side in PAIRS for k in (1, 2)])
    assert {len(holes) for holes in rows.values()} == {16}


def test_diameters(rows):
    for hole in each(rows, rows):
        assert hole.diameter == pytest.approx(DIAMETER, rel=1e-6)


def test_pitch(rows):
    for name, holes in rows.items():
        steps = np.diff([hole.exit for hole in holes], axis=0)
        assert np.abs(steps[:, :2]).max() < 1e-3, name
        assert steps[:, 2] == pytest.approx(PITCH_D * DIAMETER, abs=1e-4), name


def test_angles_of_the_sides(rows):
    for side, angle in PAIRS.items():
        for hole in each(rows, (f"{side}_1", f"{side}_2")):
            found = math.degrees(math.asin(hole.axis @ hole.normal))
            assert found == pytest.approx(angle, abs=1.0), side
            assert abs(hole.axis[2]) < 1e-6, side  # no compound angle


def test_slant_and_skew_of_the_showerhead(rows):
    for hole in each(rows, HEAD):
        assert math.degrees(math.asin(hole.axis @ hole.normal)) == pytest.approx(SLANT, abs=1.0)
        tangent = hole.axis - hole.normal * (hole.axis @ hole.normal)
        skew = math.degrees(math.acos(tangent[2] / np.linalg.norm(tangent)))
        assert skew == pytest.approx(90.0 - SKEW, abs=1.5)


def test_length_of_the_showerhead(rows):
    """The vane's curvature makes some of them a little longer."""
    for hole in each(rows, HEAD):
        assert hole.length == pytest.approx(HEAD_LENGTH, rel=0.01)


def test_rows_are_spaced_along_the_surface_and_staggered(rows, profile):
    def spacings(names):
        return np.diff([along(profile, rows[name][0]) for name in names])

    assert np.abs(spacings(HEAD)) == pytest.approx(HEAD_SPACING_D * DIAMETER, abs=0.05)
    for side in PAIRS:
        assert np.abs(spacings([f"{side}_1", f"{side}_2"])) == pytest.approx(
            PAIR_SPACING_D * DIAMETER, abs=0.05
        )
    for names in (HEAD, *([f"{side}_1", f"{side}_2"] for side in PAIRS)):
        shift = np.abs(np.diff([rows[name][0].exit[2] for name in names]))
        assert shift == pytest.approx(0.5 * PITCH_D * DIAMETER, abs=0.01)


def test_the_middle_row_looks_into_the_axial_flow(rows):
    for hole in rows["head_3"]:
        assert hole.normal == pytest.approx([-1.0, 0.0, 0.0], abs=0.01)
