"""The sidecar's meshes as arrays, and arrays as Blender meshes.

The arrays are made beside the window, by any thread; only :func:`fill` touches Blender's data.
"""

import json
from dataclasses import dataclass

import bpy
import numpy as np

from .client import mesh as wire

#: Name of the face attribute that numbers the faces of the solid, in the order of the mesh's ``FACES``.
FACE_ATTRIBUTE = "coolinggen_face"
#: The mesh's property with the names of the solid's faces, JSON.
FACES = "coolinggen_faces"


@dataclass(frozen=True)
class Arrays:
    """A solid's closed triangle mesh."""

    name: str
    points: np.ndarray
    """n x 3, mm."""
    triangles: np.ndarray
    """m x 3 indices of points, counterclockwise from outside."""
    normals: np.ndarray
    """3 m x 3, unit: the surface's normal at each corner of the triangles."""
    faces: tuple[str, ...]
    """Names of the solid's faces."""
    face_of: np.ndarray
    """m indices of faces."""
    layers: tuple[tuple[str, tuple[float, float, float]], ...]
    """Names and colours of the layers that the faces are in."""
    layer_of: np.ndarray
    """m indices of layers."""


def arrays(solid: dict) -> Arrays:
    """A solid of the reply to ``model/tessellate``.

    The sidecar gives each face vertices of its own, with the face's normals; faces that meet have equal
    vertices along their edge, which become one point here.
    """
    mesh = wire.decode(solid)
    vertices = np.frombuffer(mesh.vertices, np.float32).reshape(-1, 3)
    normals = np.frombuffer(mesh.normals, np.float32).reshape(-1, 3)
    corners = np.frombuffer(mesh.triangles, np.uint32).reshape(-1, 3)
    # As bytes, 0 and -0 were two.
    bits = np.ascontiguousarray(vertices + np.float32(0)).view(np.dtype((np.void, 12))).ravel()
    _, first, point_of = np.unique(bits, return_index=True, return_inverse=True)
    layers: dict[tuple, int] = {}
    layer_of_face = [layers.setdefault((face.layer, face.color), len(layers)) for face in mesh.faces]
    sizes = [len(face.triangles) for face in mesh.faces]
    return Arrays(
        name=mesh.name,
        points=vertices[first],
        triangles=point_of.ravel()[corners].astype(np.int32),
        normals=normals[corners.ravel()],
        faces=tuple(face.name for face in mesh.faces),
        face_of=np.repeat(np.arange(len(sizes), dtype=np.int32), sizes),
        layers=tuple(layers),
        layer_of=np.repeat(np.array(layer_of_face, dtype=np.int32), sizes),
    )


def fill(mesh, solid: Arrays, scale: float, slots: list[int]) -> None:
    """Gives ``mesh`` the geometry of ``solid`` instead of its own.

    ``scale`` is Blender units a millimetre, ``slots`` the material slot of each layer. Materials, custom
    properties and users of the mesh stay as they are.
    """
    corners = solid.triangles.size
    mesh.clear_geometry()
    mesh.vertices.add(len(solid.points))
    mesh.vertices.foreach_set("co", (solid.points * np.float32(scale)).ravel())
    mesh.loops.add(corners)
    mesh.loops.foreach_set("vertex_index", solid.triangles.ravel())
    mesh.polygons.add(len(solid.triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners, 3, dtype=np.int32))
    mesh.polygons.foreach_set("material_index", np.array(slots, dtype=np.int32)[solid.layer_of])
    mesh.attributes.new(FACE_ATTRIBUTE, "INT", "FACE").data.foreach_set("value", solid.face_of)
    mesh.update(calc_edges=True)
    _set_normals(mesh, solid.normals)
    mesh[FACES] = json.dumps(solid.faces)


def _set_normals(mesh, normals: np.ndarray) -> None:
    if bpy.app.version >= (4, 5, 0):
        # As they are; the other way costs some hundred times as much and rounds them.
        mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "CORNER").data.foreach_set(
            "vector", normals.ravel()
        )
    else:
        mesh.normals_split_custom_set(normals)


def face_names(mesh) -> list[str]:
    """Names of the faces of the solid that ``mesh`` shows, by their numbers in ``FACE_ATTRIBUTE``."""
    return json.loads(mesh.get(FACES, "[]"))
