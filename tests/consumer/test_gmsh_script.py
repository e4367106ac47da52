"""The script for Gmsh, run as it is: metal and coolant in one mesh, every triangle in one group."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

import witness

#: Share by which the cells' volume may differ from the solid's.
VOLUME_SHARE = 2e-3
POINTED = ("medial-propeller", "propeller")

#: What Gmsh tells of its own mesh, in a process of its own: it must not meet build123d's OpenCASCADE.
ASK = """
import gmsh, json, sys
import numpy as np
gmsh.initialize()
gmsh.option.setNumber("General.Verbosity", 1)
gmsh.open(sys.argv[1])
def named(dimension, kind):
    found = {}
    for _, tag in gmsh.model.getPhysicalGroups(dimension):
        name = gmsh.model.getPhysicalName(dimension, tag)
        own = [gmsh.model.mesh.getElementsByType(kind, entity)[1].astype(np.int64)
               for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag)]
        found[name] = np.concatenate(own)
    return found
numbers, coordinates, _ = gmsh.model.mesh.getNodes()
places = np.zeros((int(numbers.max()) + 1, 3))
places[numbers.astype(np.int64)] = coordinates.reshape(-1, 3)
triangles = {f"2 {name}": nodes.reshape(-1, 3) for name, nodes in named(2, 2).items()}
cells = {f"3 {name}": nodes.reshape(-1, 4) for name, nodes in named(3, 4).items()}
np.savez(sys.argv[2], places=places, **triangles, **cells)
"""


@pytest.fixture(scope="session")
def mesh(model, tmp_path_factory) -> dict[str, np.ndarray]:
    if model.name in POINTED:
        pytest.xfail("at the point of a propeller's tip Gmsh's own surface mesh lies on itself")
    if witness.too_great(model.file("assembly", "step")):
        witness.leave_to_long(f"{model.name}.gmsh.py")
    folder = tmp_path_factory.mktemp("gmsh_script")
    out = folder / "out.msh"
    script = model.folder / f"{model.name}.gmsh.py"
    done = subprocess.run(
        [sys.executable, script, "--out", out],
        capture_output=True,
        text=True,
        timeout=witness.LIMIT,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    subprocess.run([sys.executable, "-c", ASK, out, folder / "out.npz"], check=True, timeout=600)
    return dict(np.load(folder / "out.npz"))


def test_a_volume_a_solid(model, mesh):
    places = mesh["places"]
    names = {name[2:] for name in mesh if name.startswith("3 ")}
    assert names == set(model.report["solids"])
    for name in names:
        corners = places[mesh[f"3 {name}"]]
        edges = corners[:, 1:] - corners[:, :1]
        volumes = np.linalg.det(edges) / 6
        assert (volumes > 0).all(), name
        expected = model.report["solids"][name]["volume_mm3"]
        assert abs(volumes.sum() / expected - 1) <= VOLUME_SHARE, name


def test_a_group_a_group(model, mesh):
    groups = {name[2:]: len(cells) for name, cells in mesh.items() if name.startswith("2 ")}
    assert set(groups) == {group["name"] for group in model.manifest["groups"]}
    assert all(groups.values())


def test_every_triangle_of_a_border_is_in_one_group_and_interfaces_share_nodes(mesh):
    triangles = np.concatenate([nodes for name, nodes in mesh.items() if name.startswith("2 ")])
    triangles = np.sort(triangles, axis=1)
    assert len(np.unique(triangles, axis=0)) == len(triangles)
    cells = np.concatenate([nodes for name, nodes in mesh.items() if name.startswith("3 ")])
    owners = [(k, nodes) for k, (name, nodes) in enumerate(mesh.items()) if name.startswith("3 ")]
    solid = np.concatenate([np.full(len(nodes), k) for k, nodes in owners])
    sides = np.sort(np.concatenate([np.delete(cells, k, axis=1) for k in range(4)]), axis=1)
    owner = np.tile(solid, 4)
    unique, index, times = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    assert times.max() == 2
    # A side is on a border where one cell alone has it, or two of different solids.
    low, high = np.full(len(unique), 10**6), np.full(len(unique), -1)
    np.minimum.at(low, index.ravel(), owner)
    np.maximum.at(high, index.ravel(), owner)
    border = unique[(times == 1) | (low != high)]
    assert {tuple(side) for side in border.tolist()} == {tuple(side) for side in triangles.tolist()}
