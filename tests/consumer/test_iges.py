"""OpenCASCADE reads both variants of every IGES file: solids valid and closed, trimmed surfaces that sew
closed; labels and levels are those of the manifest and of the table of panels."""

from __future__ import annotations

import csv
import json

import pytest

import close
import iges
import measure
import occ
import topology

SEWING_MM = 1e-5
AREA = 1e-3  # relative, of single faces by OpenCASCADE's fixed rule
SAME = 1e-5  # relative, of one volume by the same rule from both variants


@pytest.fixture(scope="session")
def solids(model) -> dict[str, iges.File]:
    return {part: iges.read(model.file(part, "igs")) for part in model.parts}


@pytest.fixture(scope="session")
def surfaces(model) -> dict[str, iges.File]:
    return {part: iges.read(model.file(part, "surfaces.igs")) for part in model.parts}


@pytest.fixture(scope="session")
def sewn(surfaces) -> dict[str, tuple[list, int]]:
    return {
        part: iges.sewn([f for s in file.shapes for f in occ.sub_shapes(s, topology.FACE)], SEWING_MM)
        for part, file in surfaces.items()
    }


@pytest.fixture(scope="session")
def manifest(model) -> dict:
    path = model.folder / f"{model.name}.groups.json"
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def named(model, manifest, solids) -> list[tuple[str, object]]:
    """The solids of all files with their names: the manifest has these in the order of each file."""
    inside = {listed["file"]: listed["solids"] for listed in manifest["files"]}
    found = []
    for part, file in solids.items():
        shapes = [s for shape in file.shapes for s in occ.sub_shapes(shape, topology.SOLID)]
        found += zip(inside[model.file(part, "igs").name], shapes, strict=True)
    assert sorted(name for name, _ in found) == sorted(model.report["solids"])
    return found


def test_read_without_complaints(solids, surfaces):
    for files in (solids, surfaces):
        assert {part: file.complaints for part, file in files.items()} == dict.fromkeys(files, 0)


def test_solids_are_valid_and_closed(model, named):
    for name, shape in named:
        assert topology.faults(shape) == [], name
        assert topology.free_edges(shape) == 0, name
        assert topology.genus(shape) == model.report["genus"][name]["expected"], name
        assert topology.greatest_tolerance(shape) <= close.TOLERANCE_MM, name
        assert len(occ.sub_shapes(shape, topology.FACE)) == model.report["solids"][name]["faces"], name


def test_volumes_of_solids(model, named):
    for name, shape in named:
        expected = model.report["solids"][name]["volume_mm3"]
        close.assert_volume(measure.volume_adaptive(shape), expected, name)


def test_trimmed_surfaces_sew_closed(sewn):
    for part, (shells, free) in sewn.items():
        assert free == 0, part
        assert [topology.free_edges(shell) for shell in shells] == [0] * len(shells), part


def test_trimmed_surfaces_enclose_what_the_solids_do(solids, sewn):
    """Shells of solids and sewn ones, by one rule, in the order of their volumes."""
    for part, (shells, _) in sewn.items():
        held = [s for shape in solids[part].shapes for s in occ.sub_shapes(shape, topology.SHELL)]
        found, expected = (sorted(abs(measure.volume_fixed(s)) for s in kind) for kind in (shells, held))
        assert len(found) == len(expected), part
        for one, other in zip(found, expected, strict=True):
            close.assert_volume(one, other, part, SAME)


def test_assembly_has_shared_faces_once(model):
    file = iges.read(model.file("assembly", "igs"))
    solids = occ.sub_shapes(occ.compound(file.shapes), topology.SOLID)
    assert len(solids) == len(model.report["solids"])
    assert all(topology.free_edges(solid) == 0 for solid in solids)
    faces = occ.sub_shapes(occ.compound(file.shapes), topology.FACE)
    assert len(faces) == len(file.faces) == len(model.report["faces"])
    assert file.complaints == 0


@pytest.mark.parametrize("kind", ["solids", "surfaces"])
def test_labels_and_levels(request, model, manifest, kind):
    levels = {group["name"]: number for number, group in enumerate(manifest["groups"], 1)}
    for part, file in request.getfixturevalue(kind).items():
        wanted = set(model.solids(part))
        expected = {f["alias"]: f for f in manifest["faces"] if wanted & set(f["solids"])}
        assert sorted(f.label for f in file.faces) == sorted(expected), part
        for face in file.faces:
            is_face = expected[face.label]
            assert face.level == levels[is_face["group"]], is_face["name"]
            assert face.coloured, is_face["name"]
            assert close.relative(measure.area(face.shape), is_face["area_mm2"]) <= AREA, is_face["name"]


def test_table_of_panels(model, manifest, solids):
    faces = {face["alias"]: face for face in manifest["faces"]}
    for part, file in solids.items():
        with model.file(part, "centaur.csv").open(encoding="utf-8", newline="") as table:
            rows = list(csv.DictReader(table))
        assert [row["alias"] for row in rows] == [face.label for face in file.faces], part
        for row, of_file in zip(rows, file.faces, strict=True):
            face = faces[row["alias"]]
            assert (row["face"], row["group"], row["role"]) == (face["name"], face["group"], face["role"])
            assert int(row["level"]) == of_file.level, row["face"]
            assert row["boundary"] in {"viscous wall", "inflow", "outflow", "interface"}, row["face"]
