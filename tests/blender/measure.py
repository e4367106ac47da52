"""What a Blender mesh measures."""

from __future__ import annotations

import numpy as np


def triangles(mesh) -> tuple[np.ndarray, np.ndarray]:
    """Points (n x 3) and triangles (m x 3)."""
    points = np.empty(len(mesh.vertices) * 3, np.float32)
    mesh.vertices.foreach_get("co", points)
    mesh.calc_loop_triangles()
    corners = np.empty(len(mesh.loop_triangles) * 3, np.int32)
    mesh.loop_triangles.foreach_get("vertices", corners)
    return points.reshape(-1, 3).astype(float), corners.reshape(-1, 3)


def closed(mesh) -> bool:
    """Whether each edge is used twice, once each way."""
    _, corners = triangles(mesh)
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]).astype(np.int64)
    there = edges[:, 0] * len(mesh.vertices) + edges[:, 1]
    back = edges[:, 1] * len(mesh.vertices) + edges[:, 0]
    return len(np.unique(there)) == len(there) and np.array_equal(np.sort(there), np.sort(back))


def volume(mesh) -> float:
    """Volume, positive where the normals point outward."""
    points, corners = triangles(mesh)
    a, b, c = (points[corners[:, k]] - points.mean(axis=0) for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def area(mesh) -> float:
    """Area."""
    points, corners = triangles(mesh)
    a, b, c = (points[corners[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def normals(mesh) -> tuple[np.ndarray, np.ndarray]:
    """The normals of the triangles' corners, and of the triangles: both m x 3 x 3."""
    points, corners = triangles(mesh)
    given = np.empty(len(mesh.loops) * 3, np.float32)
    mesh.corner_normals.foreach_get("vector", given)
    loops = np.empty(len(mesh.loop_triangles) * 3, np.int32)
    mesh.loop_triangles.foreach_get("loops", loops)
    a, b, c = (points[corners[:, k]] for k in range(3))
    flat = np.cross(b - a, c - a)
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    return given.reshape(-1, 3)[loops].reshape(-1, 3, 3), np.repeat(flat[:, None, :], 3, axis=1)
