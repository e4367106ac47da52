"""Objects of the scene as blades: lofts, other meshes, curves, NURBS surfaces, and what is none of these."""

from __future__ import annotations

import importlib
import json
import math
import queue

import bpy
import numpy as np
import pytest
from mathutils import Matrix

import measure
from conftest import MODULE

#: Points around a section; the chord is 40 mm.
AROUND = 96


def section(height: float, count: int = AROUND, scale: float = 1.0) -> np.ndarray:
    """A section of a cambered blade (count x 2, mm), round at both ends, twisted over the height, 0 to 1."""
    t = 2 * np.pi * np.arange(count) / count
    x = 20 * np.cos(t)
    half = 4.0 * np.sin(t) * (1 + 0.35 * np.cos(t))
    y = half + 5 * (1 - (x / 20) ** 2)
    turn = math.radians(12 * height)
    scale *= 1 - 0.15 * height
    return scale * np.stack(
        [x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)], 1
    )


def linear(rings: int, bent: float = 0.0, tall: float = 60.0) -> np.ndarray:
    """Rings of a blade along z (rings x AROUND x 3, mm), each ``bent`` out of its plane."""
    made = []
    for height in np.linspace(0, 1, rings):
        flat = section(height)
        made.append(np.column_stack([flat, tall * height + bent * (flat[:, 0] / 20) ** 2]))
    return np.array(made)


def annular(rings: int) -> np.ndarray:
    """The same round the x axis, on cylinders of radii from 200 to 260 mm, at an angle of its own."""
    made = []
    for height in np.linspace(0, 1, rings):
        flat, r = section(height), 200 + 60 * height
        theta = flat[:, 1] / r + 3.0
        made.append(np.column_stack([flat[:, 0], r * np.sin(theta), r * np.cos(theta)]))
    return np.array(made)


def loft(rings: np.ndarray, millimetre: float = 1e-3, matrix: Matrix | None = None, triangles: bool = False):
    """An object of rings, its ends closed by one polygon each; ``matrix`` is its place, which the mesh makes
    up for."""
    n, m, _ = rings.shape
    points = rings.reshape(-1, 3) * millimetre
    if matrix is not None:
        back = np.array(matrix.inverted())
        points = points @ back[:3, :3].T + back[:3, 3]
    faces = [
        (k * m + j, k * m + (j + 1) % m, (k + 1) * m + (j + 1) % m, (k + 1) * m + j)
        for k in range(n - 1)
        for j in range(m)
    ]
    if triangles:
        faces = [half for a, b, c, d in faces for half in ((a, b, c), (a, c, d))]
    faces += [tuple(range(m - 1, -1, -1)), tuple(range((n - 1) * m, n * m))]
    mesh = bpy.data.meshes.new("drawn blade")
    mesh.from_pydata(points.tolist(), [], faces)
    return place(mesh, matrix)


def place(data, matrix: Matrix | None = None):
    """An active object with this data."""
    made = bpy.data.objects.new("drawn blade", data)
    if matrix is not None:
        made.matrix_world = matrix
    bpy.context.scene.collection.objects.link(made)
    bpy.context.view_layer.objects.active = made
    return made


def cooled():
    """The blade that the active object becomes."""
    drawn = bpy.context.object
    assert bpy.ops.coolinggen.from_object() == {"FINISHED"}
    assert drawn.hide_get()
    (made,) = importlib.import_module(f"{MODULE}.blades").blades()
    return made


def reaches(made, rings: np.ndarray, millimetre: float = 1e-3) -> None:
    """The blade is where the rings are, in the scene's units."""
    points, _ = measure.triangles(importlib.import_module(f"{MODULE}.blades").objects(made)["metal"].data)
    inner = rings[len(rings) // 8 + 1 : -1 - len(rings) // 8].reshape(-1, 3) * millimetre
    for low, high in ((points.min(axis=0), inner.min(axis=0)), (inner.max(axis=0), points.max(axis=0))):
        assert (low <= high + 0.1 * millimetre).all()


@pytest.mark.parametrize("scale", [1.0, 0.001])
def test_a_loft_of_quads(scale):
    bpy.context.scene.unit_settings.scale_length = scale
    millimetre = 1e-3 / scale
    matrix = Matrix.Translation((0.3, 0, 0)) @ Matrix.Rotation(0.7, 4, "Z") @ Matrix.Diagonal((2, 3, 0.5, 1))
    rings = linear(7)
    loft(rings, millimetre, matrix)
    made = cooled()
    design = json.loads(made.coolinggen.source)
    assert design["space"]["kind"] == "linear" and len(design["blade"]["sections"]) == 7
    assert made.coolinggen.fit_points == 5 * AROUND
    assert made.coolinggen.fit_mm < 0.004
    reaches(made, rings, millimetre)


def test_points_off_the_blade_are_told_how_far():
    rings = linear(5)
    loft(rings)
    made = cooled()
    blades, building, service = (
        importlib.import_module(f"{MODULE}.{name}") for name in ("blades", "building", "service")
    )
    # Half a millimetre off the middle of both sides, one of them by less.
    points = rings[2][[AROUND // 4, 3 * AROUND // 4]] + [[0.0, 0.3, 0.0], [0.0, -0.5, 0.0]]
    watch = importlib.import_module(f"{MODULE}.client.latest").Watch(0, queue.Queue())
    away, where = building.distance(blades.order(made), points, lambda: service.sidecar(""), watch)
    assert 0.45 < away <= 0.5 and where.tolist() == points[1].tolist()


def test_rings_that_lie_in_no_planes():
    rings = linear(9, bent=3.0)
    loft(rings)
    made = cooled()
    assert "span" in json.loads(made.coolinggen.source)["blade"]["sections"][0]
    assert made.coolinggen.fit_mm < 0.01
    reaches(made, rings)


@pytest.mark.parametrize(
    "rings", [annular(9), linear(9) + np.array([0, 0, 200])], ids=["cylinders", "planes"]
)
def test_a_loft_round_the_machine_axis(rings):
    loft(rings)
    made = cooled()
    assert json.loads(made.coolinggen.source)["space"]["kind"] == "annular"
    assert made.coolinggen.fit_mm < 0.01
    reaches(made, rings)


@pytest.mark.parametrize("rings", [linear(30), annular(30)], ids=["linear", "annular"])
def test_a_mesh_of_triangles(rings):
    loft(rings, triangles=True)
    made = cooled()
    # The sections may leave the cuts by 0.01 mm. Between chords of the triangles it would be 0.03.
    assert 0.0 < made.coolinggen.fit_mm < 0.011
    reaches(made, rings)


@pytest.mark.parametrize("kind", ["BEZIER", "NURBS", "POLY"])
def test_closed_curves(kind):
    data = bpy.data.curves.new("sections", "CURVE")
    data.dimensions = "3D"
    # Not in the order of their heights.
    for height in (0.5, 0.0, 1.0, 0.25, 0.75):
        flat = section(height, 32 if kind == "BEZIER" else 96) * 1e-3
        spline = data.splines.new(kind)
        if kind == "BEZIER":
            spline.bezier_points.add(len(flat) - 1)
            for point, (x, y) in zip(spline.bezier_points, flat, strict=True):
                point.co = (x, y, 0.06 * height)
            for k, point in enumerate(spline.bezier_points):
                # Along the section, a third of the way to the next.
                ahead, behind = section(height, 32 * 50)[[50 * k - 1599, 50 * k - 1]] * 1e-3
                way = 50 * (ahead - behind) / 6
                point.handle_left = (*(flat[k] - way), 0.06 * height)
                point.handle_right = (*(flat[k] + way), 0.06 * height)
        else:
            spline.points.add(len(flat) - 1)
            for point, (x, y) in zip(spline.points, flat, strict=True):
                point.co = (x, y, 0.06 * height, 1.0)
            if kind == "NURBS":
                spline.order_u = 4
        spline.use_cyclic_u = True
    place(data)
    bpy.context.view_layer.update()
    made = cooled()
    assert len(json.loads(made.coolinggen.source)["blade"]["sections"]) == 5
    # Compared at three times as many points as the blade is made of.
    assert made.coolinggen.fit_mm < 0.02


def surface(cyclic_ends: bool, weighted: bool):
    """A NURBS surface, closed round the blade, as an active object."""
    data = bpy.data.curves.new("surface", "SURFACE")
    data.dimensions = "3D"
    for k, ring in enumerate(linear(5)[:, ::4]):
        spline = data.splines.new("NURBS")
        spline.points.add(len(ring) - 1)
        for j, (point, co) in enumerate(zip(spline.points, ring * 1e-3, strict=True)):
            point.co = (*co, 1.0 + 0.2 * weighted * math.sin(math.pi * j / 12 + k))
            point.select = True
        spline.use_cyclic_u = True
        spline.order_u = 4
        spline.use_endpoint_u = cyclic_ends
    made = place(data)
    made.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curve.make_segment()
    bpy.ops.object.mode_set(mode="OBJECT")
    (spline,) = data.splines
    for way in ("u", "v"):
        if not getattr(spline, f"use_cyclic_{way}"):
            setattr(spline, f"use_endpoint_{way}", True)
            setattr(spline, f"order_{way}", 3)
    data.resolution_u = data.resolution_v = 6
    bpy.context.view_layer.update()
    return made


@pytest.mark.parametrize("weighted", [False, True])
def test_a_nurbs_surface_is_taken_as_it_is(weighted):
    surface(False, weighted)
    made = cooled()
    source = json.loads(made.coolinggen.source)["blade"]
    assert source["kind"] == "surface" and ("weights" in source) == weighted
    # What Blender shows of it lies on the blade: but for 32 bits and the mesh it is compared with, 0.001 mm.
    assert made.coolinggen.fit_points > 500 and made.coolinggen.fit_mm < 0.002
    assert bpy.ops.coolinggen.farthest() == {"FINISHED"}
    assert 0 < bpy.context.scene.cursor.location.z < 0.06


def refused(match: str) -> None:
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.coolinggen.from_object()
    assert not bpy.data.collections and not bpy.context.object.hide_get()


def test_what_is_no_closed_loft_is_refused():
    bpy.ops.mesh.primitive_torus_add(major_radius=0.05, minor_radius=0.01)
    refused("2 closed lines, a blade in one")
    bpy.ops.mesh.primitive_grid_add(size=0.05)
    refused("flat")
    bpy.ops.object.light_add()
    refused("is a light")
    place(bpy.data.meshes.new("nothing"))
    refused("no faces")
    data = bpy.data.curves.new("open", "CURVE")
    for _ in range(2):
        data.splines.new("POLY").points.add(5)
    place(data)
    refused("open")
    bpy.ops.surface.primitive_nurbs_surface_torus_add(radius=0.05)
    refused("closed in both directions")


def test_a_lying_loft_is_refused():
    loft(linear(5)[..., [2, 0, 1]])
    refused("along z")


def test_what_was_built_is_no_object_to_begin_with(rotor):
    bpy.context.view_layer.objects.active = importlib.import_module(f"{MODULE}.blades").objects(rotor)[
        "metal"
    ]
    assert not bpy.ops.coolinggen.from_object.poll()
