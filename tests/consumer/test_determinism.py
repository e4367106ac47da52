"""The same design gives the same bytes, at any number of threads."""

from __future__ import annotations

import json

import cli


def test_again_on_one_thread(model, tmp_path):
    again = cli.generate(model.design_path, tmp_path, RAYON_NUM_THREADS="1")
    assert again.returncode == cli.DONE, again.stderr
    names = files(model.folder)
    assert files(tmp_path) == names
    differing = [name for name in names if contents(model.folder / name) != contents(tmp_path / name)]
    assert differing == []


def files(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


def contents(path):
    if not path.name.endswith(".report.json"):
        return path.read_bytes()
    report = json.loads(path.read_text(encoding="utf-8"))
    report.pop("timings_ms")
    return json.dumps(report)  # keeps the order of the keys
