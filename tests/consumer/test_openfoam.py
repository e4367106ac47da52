"""OpenFOAM finds each region closed, and snappyHexMesh makes a mesh with all named patches."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

import witness

#: Where Debian's package has what OpenFOAM's programs look for.
ENVIRONMENT = {**os.environ, "WM_PROJECT_DIR": "/usr/share/openfoam"}
#: Samples whose cells are few enough for every run; snappyHexMesh takes minutes for holes.
MESHED = ("rotor", "step")


@pytest.fixture(scope="session")
def case(model) -> Path:
    return model.folder / f"{model.name}.openfoam"


def run(program: str, *arguments: str, folder: Path) -> str:
    assert shutil.which(program), f"{program} is missing: run tests/install"
    done = subprocess.run(
        [program, *arguments],
        cwd=folder,
        env=ENVIRONMENT,
        capture_output=True,
        text=True,
        timeout=witness.LIMIT,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    return done.stdout


def word(name: str) -> str:
    return re.sub(r"[^\w.-]", "_", name)


def test_regions_are_closed(model, case, tmp_path):
    for solid in model.report["solids"]:
        shutil.copy(case / "constant/triSurface" / f"{word(solid)}.stl", tmp_path)
        said = run("surfaceCheck", f"{word(solid)}.stl", folder=tmp_path)
        assert "Surface is closed" in said, solid


def test_interfaces_have_the_same_triangles(model, case):
    """Every triangle of a solid is in the surface of all, as often as once."""
    surfaces = case / "constant/triSurface"
    whole = facets(surfaces / "blade.stl")
    assert len(set(whole)) == len(whole)
    for solid in model.report["solids"]:
        assert set(facets(surfaces / f"{word(solid)}.stl")) <= set(whole), solid


def facets(path: Path) -> list[frozenset[str]]:
    corners = re.findall(r"^vertex (.*)$", path.read_text(encoding="utf-8"), re.MULTILINE)
    return [frozenset(corners[k : k + 3]) for k in range(0, len(corners), 3)]


def test_snappy_hex_mesh_has_all_patches(model, case, tmp_path):
    if model.name not in MESHED and not witness.LONG:
        witness.leave_to_long(f"{model.name}.openfoam")
    shutil.copytree(case, tmp_path / "case")
    folder = tmp_path / "case"
    dictionary = folder / "system/snappyHexMeshDict"
    # The coarse setting: a halving less at each patch.
    text = dictionary.read_text(encoding="utf-8")
    coarser = re.sub(
        r"level \((\d) \1\)", lambda m: f"level ({max(1, int(m[1]) - 1)} {max(1, int(m[1]) - 1)})", text
    )
    dictionary.write_text(coarser, encoding="utf-8")
    run("blockMesh", folder=folder)
    said = run("snappyHexMesh", "-overwrite", folder=folder)
    assert "Finished meshing" in said
    boundary = (folder / "constant/polyMesh/boundary").read_text(encoding="utf-8")
    patches = dict(re.findall(r"^    (\S+)\s*\{[^}]*nFaces\s+(\d+);", boundary, re.MULTILINE))
    outside = {word(g["name"]) for g in model.manifest["groups"] if not g["interface"]}
    assert outside <= set(patches)
    assert all(int(patches[name]) > 0 for name in outside)
    zones = (folder / "constant/polyMesh/cellZones").read_text(encoding="utf-8")
    assert {word(solid) for solid in model.report["solids"]} <= set(
        re.findall(r"^(\S+)$", zones, re.MULTILINE)
    )
