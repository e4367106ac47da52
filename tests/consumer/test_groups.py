"""The manifest: every face in one group with a role, by names that stay."""

from __future__ import annotations

import json
import re
from collections import Counter

import pytest

import cli
import close
import edits

ALIAS = re.compile(r"[A-Z][0-9A-Z]{7}")


def by_name(things: list[dict]) -> dict[str, dict]:
    named = {thing["name"]: thing for thing in things}
    assert len(named) == len(things)
    return named


def test_every_face_is_in_one_group(model):
    groups = by_name(model.manifest["groups"])
    faces = by_name(model.manifest["faces"])
    assert set(faces) == {face["name"] for face in model.report["faces"]}
    found = Counter(face["group"] for face in faces.values())
    assert found == {name: group["faces"] for name, group in groups.items()}
    assert all(face["role"] == groups[face["group"]]["role"] for face in faces.values())


def test_groups_have_roles(model):
    roles = {group["name"]: group["role"] for group in model.manifest["groups"]}
    assert "other" not in roles.values()
    # Where coolant comes in or goes out is coolant alone, and the rest of it is metal, too, or an extension.
    for face in model.manifest["faces"]:
        open_ = face["role"].endswith(("_inlet", "_outlet", "_exit"))
        assert open_ <= (len(face["solids"]) == 1 and face["solids"][0].startswith("coolant/")), face["name"]


def test_interfaces_are_between_solids(model):
    of_group: dict[str, list[bool]] = {}
    for face in model.manifest["faces"]:
        of_group.setdefault(face["group"], []).append(len(face["solids"]) > 1)
    assert {group["name"]: all(of_group[group["name"]]) for group in model.manifest["groups"]} == {
        group["name"]: group["interface"] for group in model.manifest["groups"]
    }


@pytest.mark.parametrize("things", ["faces", "groups"])
def test_aliases_are_short_and_unique(model, things):
    aliases = [thing["alias"] for thing in model.manifest[things]]
    assert len(set(aliases)) == len(aliases)
    assert all(ALIAS.fullmatch(alias) for alias in aliases)


def test_places_are_those_of_the_report(model):
    report = by_name(model.report["faces"])
    for face in model.manifest["faces"]:
        assert face["area_mm2"] == report[face["name"]]["area_mm2"]
        assert face["centroid_mm"] == report[face["name"]]["centroid_mm"]
        assert face["solids"] == report[face["name"]]["solids"]


def test_boxes_make_up_those_of_solids(model):
    for name, solid in model.report["solids"].items():
        boxes = [f["bounding_box_mm"] for f in model.manifest["faces"] if name in f["solids"]]
        low = [min(values) for values in zip(*(box["min"] for box in boxes), strict=True)]
        high = [max(values) for values in zip(*(box["max"] for box in boxes), strict=True)]
        whole = solid["bounding_box_mm"]
        assert [low, high] == [pytest.approx(whole["min"], abs=1e-8), pytest.approx(whole["max"], abs=1e-8)]


def test_files_are_listed_with_their_solids(model):
    files = {listed["file"]: listed["solids"] for listed in model.manifest["files"]}
    for part in model.parts:
        assert files[f"{model.name}.{part}.step"] == model.in_order(part)
    assert all((model.folder / file).is_file() for file in files)


def build(design: dict, folder) -> dict:
    folder.mkdir(exist_ok=True)
    path = edits.write(folder / "design.json", design)
    done = cli.run("generate", path, "--out", folder, "--format", "brep", "--solids", "metal")
    assert done.returncode == cli.DONE, done.stderr
    return json.loads((folder / f"{design['name']}.groups.json").read_text(encoding="utf-8"))


def identity(manifest: dict) -> dict[str, tuple]:
    return {face["name"]: (face["alias"], face["group"], face["role"]) for face in manifest["faces"]}


def sample(name: str) -> dict:
    return json.loads((cli.SAMPLES / f"{name}.json").read_text(encoding="utf-8"))


def test_names_stay_when_the_design_changes(tmp_path):
    design = sample("rotor-serpentine")
    before = identity(build(design, tmp_path / "before"))
    changed, *_, row = (each["name"] for each in design["cooling"]["film_rows"])
    changes = {
        "/cooling/film_rows/0/hole/diameter": lambda d: 0.95 * d,
        f"/cooling/film_rows/{len(design['cooling']['film_rows']) - 1}": edits.REMOVE,
    }
    after = identity(build(edits.edited(design, changes), tmp_path / "after"))
    dropped = {name for name in before if name.startswith(f"film/{row}/")}
    # Smaller holes may no longer cross a border that parted their walls.
    parted = {name for name in {*before, *after} if name.startswith(f"film/{changed}/")}
    assert dropped and not dropped & set(after)
    assert set(before) ^ set(after) <= dropped | parted
    assert all(before[name] == after[name] for name in set(before) & set(after))


def test_names_stay_when_a_chamber_is_added(tmp_path):
    design = sample("rotor")
    before = identity(build(design, tmp_path / "before"))
    wall = {"name": "extra", "position": 0.45, "angle_deg": 85, "thickness": 1.0}
    chamber = {"name": "added", "fillet_radius": 0.3}
    design["cooling"]["walls"].insert(1, wall)
    design["cooling"]["chambers"].insert(2, chamber)
    after = identity(build(design, tmp_path / "after"))
    # The chamber beside the new wall ends there now: its closure has another name, no other face has.
    gone = set(before) - set(after)
    assert all("/wall/" in name for name in gone) and len(gone) <= 3
    assert all(before[name] == after[name] for name in set(before) & set(after))
    assert "chamber/added/suction_side" in after


def test_the_design_may_group_otherwise(tmp_path):
    design = sample("rotor")
    design["groups"] = [
        {"faces": "blade/*_side", "name": "airfoil"},
        {"faces": "chamber/leading/*", "name": "le/cold", "role": "bore_wall"},
        {"faces": "*", "name": "rest"},
    ]
    found = identity(build(design, tmp_path))
    assert found["blade/suction_side"][1:] == ("airfoil", "hot_wall")
    assert found["chamber/leading/suction_side"][1:] == ("le/cold", "bore_wall")
    assert found["blade/tip"][1] == "rest"
    design["groups"] = [{"faces": "", "name": "a b", "role": "lid"}]
    done = cli.run("validate", edits.write(tmp_path / "broken.json", design), "--json")
    assert done.returncode == cli.REFUSED
    pointers = {fault["pointer"] for fault in json.loads(done.stdout)["faults"]}
    assert pointers == {"/groups/0/faces", "/groups/0/name", "/groups/0/role"}


def test_areas_add_up(model):
    for name, solid in model.report["solids"].items():
        total = sum(face["area_mm2"] for face in model.manifest["faces"] if name in face["solids"])
        assert close.relative(total, solid["area_mm2"]) <= 1e-6
