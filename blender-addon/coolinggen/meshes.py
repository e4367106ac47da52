"""The sidecar's meshes as arrays, and arrays as Blender meshes.

The arrays are made beside the window, by any thread; only :func:`fill` touches Blender's data.
"""

import gc
import json
from dataclasses import dataclass

import bpy
import numpy as np

from .client import mesh as wire

#: Name of the face attribute that numbers the faces of the solid, in the order of the mesh's ``FACES``.
FACE_ATTRIBUTE = "coolinggen_face"
#: Normals that differ by more make an edge of the surface, degrees.
SHARP = 1.0
#: Name of the corner attribute with the thickness of the wall, mm.
THICKNESS_ATTRIBUTE = "coolinggen_wall_thickness"
#: Whether this Blender keeps normals of corners as they are given; else they cost more and are rounded.
NORMALS_AS_THEY_ARE = bpy.app.version >= (4, 5, 0)
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
    wall_thickness: np.ndarray | None
    """3 m numbers, mm, at the triangles' corners, negative where there is no wall; none if not measured."""
    sharp: np.ndarray
    """3 m flags: whether the surface has an edge between a triangle's corner and the next."""
    normal_rows: list | None
    """The normals once more as Blender before 4.5 takes them."""


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
    thickness = None
    if mesh.wall_thickness:
        known = np.frombuffer(mesh.wall_thickness, np.float32)
        walls = np.isfinite(known)[corners].all(axis=1, keepdims=True)
        # Between a number and none a triangle would show thin walls that are not there.
        thickness = np.where(walls, known[corners], np.float32(-1)).ravel()
    at_corners, triangles = normals[corners.ravel()], point_of.ravel()[corners].astype(np.int32)
    return Arrays(
        name=mesh.name,
        points=vertices[first],
        triangles=triangles,
        normals=at_corners,
        faces=tuple(face.name for face in mesh.faces),
        face_of=np.repeat(np.arange(len(sizes), dtype=np.int32), sizes),
        layers=tuple(layers),
        layer_of=np.repeat(np.array(layer_of_face, dtype=np.int32), sizes),
        wall_thickness=thickness,
        sharp=_sharp(triangles, at_corners.reshape(-1, 3, 3)),
        normal_rows=None if NORMALS_AS_THEY_ARE else _rows(at_corners),
    )


def _sharp(triangles: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Where the normals on both sides of the edges of a closed mesh differ, by corner."""
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2).astype(np.int64)
    # Each edge is there once each way: sorted alike, the two halves lie at the same place.
    span = int(triangles.max()) + 1
    there, back = (
        np.argsort(key) for key in (ends[:, 0] * span + ends[:, 1], ends[:, 1] * span + ends[:, 0])
    )
    here, beyond = normals.reshape(-1, 3), np.roll(normals, -1, axis=1).reshape(-1, 3)
    smooth = np.ones(len(ends), bool)
    for mine, others in ((here, beyond), (beyond, here)):
        alike = np.einsum("ij,ij->i", mine[there], others[back]) > np.cos(np.radians(SHARP))
        smooth[there] &= alike
    return ~smooth


def _rows(numbers: np.ndarray) -> list:
    """As lists, made in pieces: a thread that makes one long list keeps the window waiting.

    So does the garbage collector: for so many new lists it looks through everything that Python has.
    """
    rows, collects = [], gc.isenabled()
    gc.disable()
    try:
        for k in range(0, len(numbers), 4096):
            rows += numbers[k : k + 4096].tolist()
    finally:
        if collects:
            gc.enable()
    return rows


def fill(mesh, solid: Arrays, scale: float, slots: list[int]) -> None:
    """Gives ``mesh`` the geometry of ``solid`` instead of its own.

    ``scale`` is Blender units a millimetre, ``slots`` the material slot of each layer. Materials, custom
    properties and users of the mesh stay as they are.
    """
    corners = solid.triangles.size
    mesh.clear_geometry()
    mesh.vertices.add(len(solid.points))
    mesh.loops.add(corners)
    mesh.polygons.add(len(solid.triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners, 3, dtype=np.int32))
    # By their attributes the numbers are copied as they are, which takes a tenth of the time.
    _set(mesh, "position", "FLOAT_VECTOR", "POINT", solid.points * np.float32(scale))
    _set(mesh, ".corner_vert", "INT", "CORNER", solid.triangles)
    _set(mesh, "material_index", "INT", "FACE", np.array(slots, dtype=np.int32)[solid.layer_of])
    _set(mesh, FACE_ATTRIBUTE, "INT", "FACE", solid.face_of)
    if solid.wall_thickness is not None:
        _set(mesh, THICKNESS_ATTRIBUTE, "FLOAT", "CORNER", solid.wall_thickness)
    mesh.update(calc_edges=True)
    if solid.normal_rows is None:
        _set(mesh, "custom_normal", "FLOAT_VECTOR", "CORNER", solid.normals)
        # Cycles has one normal a point, and parts the mesh along these edges first.
        edge = np.empty(corners, np.int32)
        mesh.attributes[".corner_edge"].data.foreach_get("value", edge)
        sharp = np.zeros(len(mesh.edges), bool)
        sharp[edge] = solid.sharp
        _set(mesh, "sharp_edge", "BOOLEAN", "EDGE", sharp)
    else:
        mesh.normals_split_custom_set(solid.normal_rows)
    mesh[FACES] = json.dumps(solid.faces)


def _set(mesh, name: str, kind: str, domain: str, values: np.ndarray) -> None:
    """Gives a mesh an attribute, made where it isn't there."""
    found = mesh.attributes.get(name) or mesh.attributes.new(name, kind, domain)
    found.data.foreach_set("vector" if kind == "FLOAT_VECTOR" else "value", values.ravel())


def face_names(mesh) -> list[str]:
    """Names of the faces of the solid that ``mesh`` shows, by their numbers in ``FACE_ATTRIBUTE``."""
    return json.loads(mesh.get(FACES, "[]"))
