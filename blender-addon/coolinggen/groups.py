"""Vertex groups of a solid's faces, kept when the solid changes."""

import fnmatch
import json

import numpy as np

from . import blades
from .meshes import FACE_ATTRIBUTE, face_names

#: The object's property with the pattern of the names whose faces are groups.
PATTERN = "coolinggen_groups"
#: The object's property with the names of the groups that were made, JSON: others are the user's.
MADE = "coolinggen_groups_made"


def make(solid, pattern: str) -> int:
    """Gives each face whose name matches ``pattern`` a vertex group, instead of earlier ones; how many."""
    wanted = {
        number: name
        for number, name in enumerate(face_names(solid.data))
        if fnmatch.fnmatchcase(name, pattern)
    }
    _forget(solid, set(wanted.values()))
    for number, vertices in _vertices(solid.data).items():
        if number in wanted:
            name = wanted[number]
            group = solid.vertex_groups.get(name) or solid.vertex_groups.new(name=name)
            group.add(vertices, 1.0, "REPLACE")
    solid[PATTERN], solid[MADE] = pattern, json.dumps(list(wanted.values()))
    return len(wanted)


def again(collection, name: str) -> None:
    """Fills the groups of a solid whose mesh has changed, if it has any."""
    solid = blades.objects(collection).get(name)
    if solid is not None and solid.get(PATTERN):
        make(solid, solid[PATTERN])


def _forget(solid, wanted: set[str]) -> None:
    """Takes away the groups made earlier that are not wanted any more."""
    for name in json.loads(solid.get(MADE, "[]")):
        group = solid.vertex_groups.get(name)
        if group is not None and name not in wanted:
            solid.vertex_groups.remove(group)


def _vertices(mesh) -> dict[int, list[int]]:
    """The vertices of each face of the solid, by its number."""
    face = np.empty(len(mesh.polygons), np.int32)
    mesh.attributes[FACE_ATTRIBUTE].data.foreach_get("value", face)
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.attributes[".corner_vert"].data.foreach_get("value", corners)
    # The mesh has triangles alone.
    pairs = np.unique(np.stack([np.repeat(face, 3), corners], axis=1), axis=0)
    numbers, first = np.unique(pairs[:, 0], return_index=True)
    parts = np.split(pairs[:, 1], first[1:])
    return {int(number): part.tolist() for number, part in zip(numbers, parts, strict=True)}
