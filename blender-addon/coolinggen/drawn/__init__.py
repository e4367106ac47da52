"""Blades that are drawn in the scene already: objects into designs.

A NURBS surface is taken as it is; of a loft of quads, of closed curves and of any other closed mesh the
sections are. Everything is in mm and in the world's coordinates: the blade stands where the object does.
"""

from dataclasses import dataclass

import numpy as np

from ..client import begin
from . import curves, lofts, meshes
from .sections import Stream, of_cuts, of_rings


@dataclass(frozen=True)
class Drawn:
    """A design for an object, and points of the object that its blade is to go through, n x 3, mm."""

    design: dict
    points: np.ndarray


def design(context, drawn) -> Drawn:
    """A design for the object ``drawn``.

    Raises ValueError, saying why, if it is no closed loft.
    """
    millimetres = 1e3 * context.scene.unit_settings.scale_length
    matrix = np.array(drawn.matrix_world) * np.array([[millimetres]] * 3 + [[1.0]])
    match drawn.type:
        case "SURFACE":
            points = meshes.read(context, drawn, matrix).points
            space, source = _space(points), curves.surface(drawn.data, matrix)
        case "CURVE":
            rings, points = curves.rings(drawn.data, matrix)
            space, source = _of_rings(rings, points)
        case "MESH":
            mesh = meshes.read(context, drawn, matrix)
            points, rings = mesh.points, lofts.rings(mesh)
            if rings is not None:
                space, source = _of_rings(list(rings), points)
            else:
                space = _space(points)
                source = of_cuts(mesh, Stream(space))
        case kind:
            raise ValueError(f"{drawn.name} is a {kind.lower()}: a mesh, a curve or a surface can be a blade")
    return Drawn(begin.design(drawn.name, points.tolist(), space, source), points)


def _of_rings(rings: list[np.ndarray], points: np.ndarray) -> tuple[dict, dict]:
    """The space that rings stand in, and the blade's source."""
    height = sorted(rings, key=lambda ring: np.hypot(ring[:, 1], ring[:, 2]).mean())
    space = _space(points, (height[0].tolist(), height[-1].tolist()))
    return space, of_rings(rings, Stream(space))


def _space(points: np.ndarray, ends=None) -> dict:
    if not (np.ptp(points, axis=0) > 0).all():
        raise ValueError("the object is flat")
    return begin.space(points.tolist(), ends)


def reached(space: dict, points: np.ndarray) -> np.ndarray:
    """Those of the points that are between hub and shroud of a space that :func:`begin.space` made."""
    span = Stream(space).span(points)
    return points[(span > 0.0) & (span < 1.0)]
