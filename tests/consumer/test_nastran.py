"""Nastran files: each group a property by name, triangles closed, in place."""

from __future__ import annotations

import numpy as np
import pytest

import close


def fields(line: str, width: int) -> list[str]:
    return [line[8 + i : 8 + i + width].strip() for i in range(0, len(line.rstrip()) - 8, width)]


def parse(path) -> tuple[dict[int, str], np.ndarray, np.ndarray, np.ndarray]:
    """Names of properties, points, triangles and their properties."""
    names, points, triangles, properties = {}, [], [], []
    lines = iter(path.read_text(encoding="utf-8").splitlines())
    for line in lines:
        if line.startswith("$ANSA_NAME;"):
            names[int(line.split(";")[1])] = next(lines)[1:]
        elif line.startswith("GRID*"):
            number, _, x, y = fields(line[:72], 16)
            points.append([float(x), float(y), float(fields(next(lines), 16)[0])])
            assert int(number) == len(points)
        elif line.startswith("CTRIA3"):
            _, owner, *corners = map(int, fields(line, 8))
            triangles.append([corner - 1 for corner in corners])
            properties.append(owner)
    return names, np.array(points), np.array(triangles), np.array(properties)


@pytest.fixture(scope="session")
def meshes(model) -> dict[str, tuple]:
    return {part: parse(model.file(part, "nas")) for part in model.parts}


def test_a_property_a_group(model, meshes):
    group_of = {face["name"]: face["group"] for face in model.manifest["faces"]}
    for part, (names, _, _, properties) in meshes.items():
        assert (
            {names[number] for number in properties}
            == set(names.values())
            == {group_of[name] for name in model.face_names(part)}
        )


def test_closed_and_of_the_reported_volume(model, meshes):
    for part, (_, points, triangles, _) in meshes.items():
        sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        ways, times = np.unique(sides, axis=0, return_counts=True)
        back = {tuple(way) for way in ways[:, ::-1].tolist()}
        assert times.max() == 1 and back == {tuple(way) for way in ways.tolist()}, part
        a, b, c = (points[triangles[:, k]] for k in range(3))
        volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
        assert close.relative(volume, model.total(part, "volume_mm3")) <= 0.02, part
