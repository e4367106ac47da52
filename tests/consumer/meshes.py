"""Readers of exported meshes, small and strict, and the questions asked of them.

Every reader gives regions (one a face name) in millimetres with z along the blade, whatever the file uses.
"""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass(frozen=True)
class Region:
    """The triangles of one face: stored coordinates tell which corners are one point, `corners` is in mm."""

    name: str
    stored: np.ndarray  # (t, 3, 3) as in the file, exact
    corners: np.ndarray  # (t, 3, 3) in mm
    normals: np.ndarray | None = None  # (t, 3, 3) where the file has them


# ------------------------------------------------------------------------------------------------ questions


def sides_not_paired(regions: list[Region]) -> int:
    """Triangle sides without exactly one partner in the other direction, corners welded only when equal."""
    stored = np.concatenate([r.stored for r in regions]) + 0.0  # -0.0 becomes 0.0
    _, corner = np.unique(stored.reshape(-1, 3), axis=0, return_inverse=True)
    triangles = corner.reshape(-1, 3)
    there = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    # Each directed side once, and its reverse once.
    sides, times = np.unique(there, axis=0, return_counts=True)
    back = sides[:, ::-1]
    paired = np.isin(_keys(back), _keys(sides))
    return int((times != 1).sum() + (~paired).sum())


def _keys(sides: np.ndarray) -> np.ndarray:
    return sides[:, 0].astype(np.int64) << 32 | sides[:, 1].astype(np.int64)


def genus(regions: list[Region]) -> float:
    """Handles by Euler's formula, all shells together: shells - (V - E + F) / 2 with E = 3 F / 2."""
    stored = np.concatenate([r.stored for r in regions]) + 0.0
    points, corner = np.unique(stored.reshape(-1, 3), axis=0, return_inverse=True)
    triangles = corner.reshape(-1, 3)
    return shells(triangles, len(points)) - (len(points) - len(triangles) / 2) / 2


def shells(triangles: np.ndarray, points: int) -> int:
    """Pieces that hang together: every point takes the least number among its neighbours', and the number
    which that one has taken, until nothing changes."""
    least = np.arange(points)
    while True:
        before = least.copy()
        np.minimum.at(least, triangles, least[triangles].min(axis=1, keepdims=True))
        least = least[least]
        if (least == before).all():
            return len(np.unique(least))


def degenerate(regions: list[Region]) -> int:
    """Triangles with two corners at one point."""
    stored = np.concatenate([r.stored for r in regions])
    return int(sum((stored[:, i] == stored[:, (i + 1) % 3]).all(1).sum() for i in range(3)))


def volume(regions: list[Region]) -> float:
    """Signed: positive when the triangles turn outward."""
    a, b, c = np.moveaxis(np.concatenate([r.corners for r in regions]), 1, 0)
    origin = a.mean(0)
    return float((np.cross(a - origin, b - origin) * (c - origin)).sum() / 6)


def area(regions: list[Region]) -> float:
    a, b, c = np.moveaxis(np.concatenate([r.corners for r in regions]), 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def box(regions: list[Region]) -> np.ndarray:
    points = np.concatenate([r.corners for r in regions]).reshape(-1, 3)
    return np.array([points.min(0), points.max(0)])


def normals_turned_away(regions: list[Region]) -> int:
    """Corners whose given normal points to the other side of their triangle."""
    count = 0
    for region in regions:
        if region.normals is not None:
            a, b, c = np.moveaxis(region.corners, 1, 0)
            across = np.cross(b - a, c - a)
            count += int((np.einsum("tkx,tx->tk", region.normals, across) < 0).sum())
    return count


# -------------------------------------------------------------------------------------------------- readers


def read_obj(path: Path) -> list[Region]:
    vertices: list[list[float]] = []
    groups: dict[str, list[list[int]]] = {}
    materials: dict[str, str] = {}
    current = None
    for line in path.read_text(encoding="utf-8").splitlines():
        key, *values = line.split()[:4] or [""]
        if key == "v":
            vertices.append([float(v) for v in values])
        elif key in ("g", "o"):
            current = line.split(maxsplit=1)[1]
        elif key == "usemtl":
            materials[current] = values[0]
        elif key == "mtllib":
            library = (path.parent / line.split(maxsplit=1)[1]).read_text(encoding="utf-8")
            known = {row.split(maxsplit=1)[1] for row in library.splitlines() if row.startswith("newmtl")}
        elif key == "f":
            assert len(line.split()) == 4, f"{path.name}: not a triangle: {line}"
            index = [int(v.split("/")[0]) for v in values]
            groups.setdefault(current, []).append([i - 1 if i > 0 else len(vertices) + i for i in index])
    assert set(materials) >= set(groups), f"{path.name}: groups without a material"
    assert set(materials.values()) <= known, f"{path.name}: materials that its library does not define"
    points = np.array(vertices)
    return [Region(name, points[t], points[t]) for name, t in groups.items()]


def read_stl(path: Path) -> list[Region]:
    """ASCII STL, one `solid` block a face; the printed normals are compared like those of a GLB."""
    regions, name, corners, normals = [], None, [], []
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "solid":
            name, corners, normals = line.strip().split(maxsplit=1)[1], [], []
        elif words[0] == "facet":
            normals.append([float(w) for w in words[2:5]])
        elif words[0] == "vertex":
            corners.append([float(w) for w in words[1:4]])
        elif words[0] == "endsolid":
            assert line.strip().split(maxsplit=1)[1] == name, f"{path.name}: {line} does not end {name}"
            points = np.array(corners).reshape(-1, 3, 3)
            regions.append(Region(name, points, points, np.repeat(np.array(normals)[:, None], 3, axis=1)))
    return regions


@dataclass(frozen=True)
class Node:
    name: str
    translation: np.ndarray
    regions: list[Region]
    colours: dict[str, tuple[float, ...]]


_COMPONENTS = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def read_glb(path: Path) -> list[Node]:
    """One node a solid. glTF is metres with y up: (x, y, z) there is (x, -z, y) of the blade."""
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data)), f"{path.name}: bad header"
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON" and size % 4 == 0
    document = json.loads(data[20 : 20 + size])
    binary_size, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert kind == b"BIN\0" and 28 + size + binary_size == length
    binary = data[28 + size :]

    def array(index: int) -> np.ndarray:
        accessor = document["accessors"][index]
        view = document["bufferViews"][accessor["bufferView"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        width, component = _WIDTHS[accessor["type"]], np.dtype(_COMPONENTS[accessor["componentType"]])
        assert start % component.itemsize == 0, f"{path.name}: accessor {index} is not aligned"
        size = width * component.itemsize
        stride = view.get("byteStride", size)
        end = start - view.get("byteOffset", 0) + (accessor["count"] - 1) * stride + size
        assert stride % component.itemsize == 0 and end <= view["byteLength"]
        shape, strides = (accessor["count"], width), (stride, component.itemsize)
        values = np.ndarray(shape, component, binary, start, strides).copy()
        if {"min", "max"} <= set(accessor):
            assert (values.min(0) == np.array(accessor["min"], component)).all(), f"{path.name}: wrong min"
            assert (values.max(0) == np.array(accessor["max"], component)).all(), f"{path.name}: wrong max"
        return values

    nodes = []
    for index in document["scenes"][document.get("scene", 0)]["nodes"]:
        node = document["nodes"][index]
        assert not set(node) & {"rotation", "scale", "matrix"}, f"{path.name}: only a translation is expected"
        translation = np.array(node.get("translation", [0, 0, 0]), float)
        regions, colours = [], {}
        for primitive in document["meshes"][node["mesh"]]["primitives"]:
            assert primitive.get("mode", 4) == 4, f"{path.name}: triangles are expected"
            assert "min" in document["accessors"][primitive["attributes"]["POSITION"]], (
                "POSITION needs min and max"
            )
            material = document["materials"][primitive["material"]]
            positions, triangles = array(primitive["attributes"]["POSITION"]), array(primitive["indices"])
            assert triangles.max() < len(positions)
            triangles = triangles.reshape(-1, 3)
            normals = None
            if "NORMAL" in primitive["attributes"]:
                given = array(primitive["attributes"]["NORMAL"])
                assert np.allclose(np.linalg.norm(given, axis=1), 1, atol=1e-3), (
                    f"{path.name}: normals not unit"
                )
                normals = _blade_axes(given.astype(float)[triangles])
            stored = positions[triangles]
            corners = 1000 * _blade_axes(stored.astype(float) + translation)
            regions.append(Region(primitive["extras"]["name"], stored, corners, normals))
            colours[material["name"]] = tuple(material["pbrMetallicRoughness"]["baseColorFactor"])
        nodes.append(Node(node["name"], translation, regions, colours))
    return nodes


def _blade_axes(gltf: np.ndarray) -> np.ndarray:
    return np.stack([gltf[..., 0], -gltf[..., 2], gltf[..., 1]], axis=-1)
