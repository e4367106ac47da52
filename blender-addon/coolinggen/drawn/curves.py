"""Blender's splines: NURBS surfaces as they are, closed curves as rings of points."""

import numpy as np
from mathutils.geometry import interpolate_bezier

from .meshes import moved

#: Points a closed curve is taken at, and how many times as many it is compared at.
AROUND, CHECKED = 160, 3


def surface(data, matrix: np.ndarray) -> dict:
    """A surface object's data as the design's ``surface``.

    Raises ValueError if it is not one NURBS surface that is closed one way.
    """
    splines = list(data.splines)
    if len(splines) != 1 or splines[0].point_count_v < 2 or splines[0].point_count_u < 2:
        raise ValueError("a blade is one NURBS surface, with points in both directions")
    spline = splines[0]
    if spline.use_cyclic_u and spline.use_cyclic_v:
        raise ValueError("the surface is closed in both directions: a blade is open from hub to shroud")
    points, weights = _points(spline, matrix)
    shape = spline.point_count_v, spline.point_count_u
    # Blender's u runs first; the design's list is over u of lists over v.
    net = points.reshape(*shape, 3).swapaxes(0, 1)
    weights = weights.reshape(shape).T
    knots_u, around = knots(spline, "u")
    knots_v, along = knots(spline, "v")
    net, weights = net[around][:, along], weights[around][:, along]
    made = {
        "kind": "surface",
        "degree_u": spline.order_u - 1,
        "degree_v": spline.order_v - 1,
        "knots_u": knots_u,
        "knots_v": knots_v,
        "points": net.tolist(),
    }
    if not np.allclose(weights, weights[0, 0], rtol=1e-6):
        made["weights"] = weights.tolist()
    return made


def knots(spline, way: str) -> tuple[list[float], list[int]]:
    """Knots in direction ``way``, "u" or "v", as Blender has them, and the numbers of the control points,
    some of them twice where it is cyclic.
    """
    count, order = getattr(spline, f"point_count_{way}"), getattr(spline, f"order_{way}")
    cyclic, ends = getattr(spline, f"use_cyclic_{way}"), getattr(spline, f"use_endpoint_{way}")
    bezier = getattr(spline, f"use_bezier_{way}")
    # How often an inner knot is there, the first one, and how many at the end repeat the beginning.
    times = order - 1 if bezier else 1
    first = order - cyclic if ends else min(2, times) if bezier else 1
    repeated = 2 * order - 1 if cyclic else order if ends else 0
    around = [k % count for k in range(count + (order - 1) * cyclic)]
    values = [0.0] * (ends and cyclic)
    value, left = float(len(values)), first
    while len(values) < len(around) + order - repeated:
        values.append(value)
        left -= 1
        if left == 0:
            value, left = value + 1.0, times
    for k in range(repeated):
        values.append(value + values[k] - values[0])
    return values, around


def rings(data, matrix: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
    """The closed curves of a curve object's data, each as points around it, and points to compare with.

    Raises ValueError if there are not at least two, or one is open.
    """
    splines = list(data.splines)
    if len(splines) < 2:
        raise ValueError("a blade's sections are two closed curves or more, from hub to shroud")
    if not all(spline.use_cyclic_u for spline in splines):
        raise ValueError("each curve must be closed (cyclic): one of them is open")
    found = [_around(spline, matrix, AROUND) for spline in splines]
    checked = np.concatenate([_around(spline, matrix, CHECKED * AROUND) for spline in splines])
    return found, checked


def _around(spline, matrix: np.ndarray, count: int) -> np.ndarray:
    """About so many points around a closed curve; the corners of a polygon."""
    if spline.type == "BEZIER":
        points = list(spline.bezier_points)
        each = max(2, round(count / len(points)))
        sampled = [
            point
            for a, b in zip(points, points[1:] + points[:1], strict=True)
            for point in interpolate_bezier(a.co, a.handle_right, b.handle_left, b.co, each + 1)[:-1]
        ]
        return moved(np.array(sampled), matrix)
    points, weights = _points(spline, matrix)
    if spline.type == "POLY":
        return points
    values, wrapped = knots(spline, "u")
    degree = spline.order_u - 1
    start, end = values[degree], values[len(wrapped)]
    basis = _basis(np.array(values), degree, start + (end - start) * np.arange(count) / count)
    weighted = basis * weights[wrapped]
    return (weighted @ points[wrapped]) / weighted.sum(axis=1, keepdims=True)


def _points(spline, matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Control points (n x 3, mm) and weights."""
    given = np.empty(4 * len(spline.points), np.float32)
    spline.points.foreach_get("co", given)
    given = given.reshape(-1, 4).astype(float)
    return moved(given[:, :3], matrix), given[:, 3]


def _basis(values: np.ndarray, degree: int, at: np.ndarray) -> np.ndarray:
    """The B-spline functions of the knots ``values`` at some parameters, a row each (Cox and de Boor)."""
    low, high = values[:-1], values[1:]
    made = ((low <= at[:, None]) & (at[:, None] < high)).astype(float)
    for p in range(1, degree + 1):
        rise, fall = values[p:-1] - values[: -p - 1], values[p + 1 :] - values[1:-p]
        with np.errstate(divide="ignore", invalid="ignore"):
            up = np.where(rise > 0, (at[:, None] - values[: -p - 1]) / rise, 0.0)
            down = np.where(fall > 0, (values[p + 1 :] - at[:, None]) / fall, 0.0)
        made = up * made[:, :-1] + down * made[:, 1:]
    return made
