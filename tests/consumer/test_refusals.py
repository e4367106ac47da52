"""Designs that cannot be built are refused: exit code 2, every fault with its pointer, and no file left."""

from __future__ import annotations

import json

import pytest

import broken
import cli
import edits


def sample(name: str) -> dict:
    return json.loads((cli.SAMPLES / f"{name}.json").read_text(encoding="utf-8"))


def faults(done) -> list[dict]:
    """The list of faults from whichever stream holds JSON, bare or in an object."""
    for text in (done.stdout, done.stderr):
        try:
            found = json.loads(text)
        except ValueError:
            continue
        if isinstance(found, dict):
            found = next((value for value in found.values() if isinstance(value, list)), None)
        if found:
            return found
    raise AssertionError(f"no faults as JSON\nstdout: {done.stdout[:2000]}\nstderr: {done.stderr[:2000]}")


def refuse(path, out) -> list[dict]:
    """Runs `generate` and checks what holds for every refusal."""
    done = cli.generate(path, out, "--json")
    assert "panicked" not in done.stderr, done.stderr[:2000]
    assert done.returncode == cli.REFUSED, (
        f"exit {done.returncode}\n{done.stdout[:2000]}\n{done.stderr[:2000]}"
    )
    assert not out.exists() or not any(out.rglob("*")), "a refused design left files"
    found = faults(done)
    for fault in found:
        assert fault["pointer"] == "" or fault["pointer"].startswith("/"), fault
        assert fault["message"].strip(), fault
    return found


def meets(pointer: str, place: str) -> bool:
    """The fault is at the place, below it, or at what holds it directly."""
    place = place.removesuffix("/-")
    holder = place.rpartition("/")[0]
    return pointer == place or pointer.startswith(f"{place}/") or pointer == holder != ""


@pytest.mark.parametrize("case", broken.CASES, ids=lambda case: f"{case.sample}: {case.name}")
def test_broken_design(case: broken.Case, library, tmp_path):
    design = edits.edited(sample(case.sample), case.changes)
    found = refuse(edits.write(tmp_path / "design.json", design), tmp_path / "out")
    pointers = [fault["pointer"] for fault in found]
    assert any(meets(pointer, place) for pointer in pointers for place in case.places), found


def test_all_faults_at_once(library, tmp_path):
    design = edits.edited(sample("rotor"), broken.SEVERAL)
    found = refuse(edits.write(tmp_path / "design.json", design), tmp_path / "out")
    for place in broken.SEVERAL:
        assert any(fault["pointer"].startswith(place) for fault in found), f"{place} is not in {found}"


def test_a_number_out_of_range_tells_value_limit_and_unit(library, tmp_path):
    changes = {f"{broken.CHAMBERS}/0/fillet_radius": -0.6}
    design = edits.edited(sample("rotor"), changes)
    found = refuse(edits.write(tmp_path / "design.json", design), tmp_path / "out")
    (fault,) = (fault for fault in found if fault["pointer"] in changes)
    assert fault["value"] == -0.6
    assert fault["unit"] == "mm"
    assert any(isinstance(fault.get(key), int | float) for key in ("limit", "min", "max")), fault


@pytest.mark.parametrize("name", broken.NOT_JSON)
def test_not_a_design(name: str, library, tmp_path):
    text = broken.NOT_JSON[name]
    if text is None:
        whole = edits.text(sample("rotor")).encode()
        text = whole[: len(whole) // 2]
    path = tmp_path / "design.json"
    path.write_bytes(text)
    refuse(path, tmp_path / "out")


def test_a_million_sections(library, tmp_path):
    section = '{"span":0.5,"suction_side":[[0,0]],"pressure_side":[[0,0]]}'
    marker = "MILLION"
    design = edits.text(edits.edited(sample("rotor"), {broken.SECTIONS: marker}))
    text = design.replace(f'"{marker}"', "[" + ",".join([section] * 1_000_000) + "]")
    refuse(edits.write(tmp_path / "design.json", text), tmp_path / "out")


def test_no_such_file(library, tmp_path):
    done = cli.generate(tmp_path / "missing.json", tmp_path / "out", "--json")
    assert done.returncode == cli.OTHER
    assert "missing.json" in done.stdout + done.stderr
    assert not (tmp_path / "out").exists()


def step_samples() -> list[tuple]:
    """Samples whose blade comes from a STEP file, with the field that names it."""
    found = []
    for path in cli.samples():
        blade = json.loads(path.read_text(encoding="utf-8")).get("blade", {})
        names = [
            key for key, value in blade.items() if isinstance(value, str) and (path.parent / value).is_file()
        ]
        found += [pytest.param(path, key, id=path.stem) for key in names]
    return found


STEP_FILES = {
    "empty": lambda data: b"",
    "cut short": lambda data: data[: len(data) // 2],
    "without B-splines": lambda data: data.replace(b"B_SPLINE", b"C_SPLINE"),
    "something else": lambda data: bytes(range(256)) * 64,
}


@pytest.mark.parametrize("damage", STEP_FILES)
@pytest.mark.parametrize(("path", "key"), step_samples())
def test_damaged_step_file(path, key: str, damage: str, library, tmp_path):
    design = json.loads(path.read_text(encoding="utf-8"))
    source = path.parent / design["blade"][key]
    (tmp_path / "damaged.step").write_bytes(STEP_FILES[damage](source.read_bytes()))
    changed = edits.edited(design, {f"/blade/{key}": "damaged.step"})
    found = refuse(edits.write(tmp_path / "design.json", changed), tmp_path / "out")
    assert any(fault["pointer"].startswith("/blade") for fault in found), found
