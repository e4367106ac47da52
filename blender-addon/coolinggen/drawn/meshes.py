"""Meshes of the scene as arrays in mm."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

#: Triangles that meet at a greater angle do so in an edge, degrees.
SHARP = 40.0


@dataclass(frozen=True)
class Edges:
    """The edges of a mesh's triangles."""

    ends: np.ndarray
    """n x 2 indices of points."""
    of_triangles: np.ndarray
    """m x 3 indices of edges."""
    curves: np.ndarray
    """n x 4 x 3: control points of cubic Bezier curves, at right angles to the mesh's normals at both ends.

    A. Vlachos et al., Curved PN triangles, 2001.
    """


@dataclass(frozen=True)
class Mesh:
    """A mesh whose vertices are all at different places."""

    points: np.ndarray
    """n x 3, mm."""
    polygons: list[tuple[int, ...]]
    """Indices of points."""
    triangles: np.ndarray
    """The same, m x 3."""

    @cached_property
    def edges(self) -> Edges:
        """The edges of the triangles."""
        pairs = np.stack([self.triangles, np.roll(self.triangles, -1, axis=1)], axis=2)
        ends, number = np.unique(np.sort(pairs, axis=2).reshape(-1, 2), axis=0, return_inverse=True)
        of_triangles = number.reshape(-1, 3)
        corner, begin = self._normals(), pairs[..., 0] == ends[of_triangles][..., 0]
        normals = np.zeros((len(ends), 2, 3))
        for k in range(3):
            here, there = corner[:, k], corner[:, (k + 1) % 3]
            np.add.at(normals[:, 0], of_triangles[:, k], np.where(begin[:, k, None], here, there))
            np.add.at(normals[:, 1], of_triangles[:, k], np.where(begin[:, k, None], there, here))
        normals = _unit(normals)
        a, b = self.points[ends[:, 0]], self.points[ends[:, 1]]
        off = np.einsum("ik,ijk->ij", b - a, normals)[..., None] * normals
        curves = np.stack([a, a + (b - a - off[:, 0]) / 3, b - (b - a - off[:, 1]) / 3, b], axis=1)
        return Edges(ends, of_triangles, curves)

    def _normals(self) -> np.ndarray:
        """Normals at the triangles' corners (m x 3 x 3): means of the triangles round the point, as far as no
        edge is between.

        They weigh as much as their angle there, by which two halves of a quad weigh as the whole, but flat
        corners as little as sharp ones: such slivers, of polygons that close a blade's ends, point anywhere.
        """
        corners = self.points[self.triangles]
        flat = _unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
        legs = [_unit(np.roll(corners, -k, axis=1) - corners) for k in (1, 2)]
        angles = np.arccos(np.clip(np.einsum("ijk,ijk->ij", *legs), -1.0, 1.0))
        weights = np.minimum(angles, np.pi - angles).ravel()
        order = np.argsort(self.triangles.ravel(), kind="stable")
        point = self.triangles.ravel()[order]
        first = np.flatnonzero(np.diff(point, prepend=-1))
        sizes = np.diff(np.append(first, len(point)))
        summed = np.zeros((len(order), 3))
        begin, size = np.repeat(first, sizes), np.repeat(sizes, sizes)
        for k in range(sizes.max()):
            # Of each corner the k-th at the same point.
            other = order[np.where(k < size, begin + k, begin)]
            alike = np.einsum("ij,ij->i", flat[order // 3], flat[other // 3]) > np.cos(np.radians(SHARP))
            weight = weights[other] * (alike & (k < size))
            summed[order] += weight[:, None] * flat[other // 3]
        return _unit(summed).reshape(-1, 3, 3)


def read(context, drawn, matrix: np.ndarray) -> Mesh:
    """The mesh of an object with its modifiers, moved by ``matrix`` (4 x 4).

    Raises ValueError if it has no faces.
    """
    evaluated = drawn.evaluated_get(context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    try:
        if not mesh.polygons:
            raise ValueError(f"{drawn.name} has no faces")
        points = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", points)
        # What other programs' files leave apart along edges is one vertex here.
        points, place = np.unique(points.reshape(-1, 3) + np.float32(0), axis=0, return_inverse=True)
        place = place.ravel()
        polygons = [tuple(place[list(polygon.vertices)].tolist()) for polygon in mesh.polygons]
        mesh.calc_loop_triangles()
        triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", triangles)
    finally:
        evaluated.to_mesh_clear()
    return Mesh(moved(points, matrix), polygons, place[triangles].reshape(-1, 3))


def _unit(vectors: np.ndarray) -> np.ndarray:
    """The vectors' directions; none stays none."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


def moved(points: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Points (n x 3) moved by a matrix (4 x 4)."""
    return points.astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
