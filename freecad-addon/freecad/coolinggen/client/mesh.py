"""Meshes as ``model/tessellate`` sends them."""

import array
import base64
import sys
from dataclasses import dataclass


@dataclass(frozen=True)
class Face:
    """A face of a mesh: its part of the vertices and triangles."""

    name: str
    layer: str
    color: tuple[float, float, float]
    vertices: range
    triangles: range


@dataclass(frozen=True)
class Mesh:
    """The mesh of a solid: ``vertices`` and ``normals`` are x, y, z, x, ..., ``triangles`` three indices."""

    name: str
    vertices: array.array
    normals: array.array
    triangles: array.array
    faces: list[Face]
    #: Wall thickness at each vertex, mm, not a number where there is none; empty if it was not asked for.
    wall_thickness: array.array

    def points(self, face: Face) -> list[tuple[float, float, float]]:
        """The vertices of a face, mm."""
        v = self.vertices
        return [(v[3 * k], v[3 * k + 1], v[3 * k + 2]) for k in face.vertices]


def decode(solid: dict) -> Mesh:
    """A solid of the reply."""
    faces, vertex, triangle = [], 0, 0
    for face in solid["faces"]:
        vertices = range(vertex, vertex + face["vertices"])
        triangles = range(triangle, triangle + face["triangles"])
        faces.append(Face(face["name"], face["layer"], tuple(face["color"]), vertices, triangles))
        vertex, triangle = vertices.stop, triangles.stop
    return Mesh(
        solid["name"],
        _numbers("f", solid["vertices"]),
        _numbers("f", solid["normals"]),
        _numbers("I", solid["triangles"]),
        faces,
        _numbers("f", solid.get("wall_thickness_mm", "")),
    )


def _numbers(kind: str, text: str) -> array.array:
    numbers = array.array(kind, base64.b64decode(text))
    if sys.byteorder == "big":
        numbers.byteswap()
    return numbers
