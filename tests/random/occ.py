#!/usr/bin/env python3
"""OpenCASCADE on what `coolinggen-random --out DIR` wrote: every product one solid, valid, closed, of the
expected genus and volume.

    tests/.venv/bin/python tests/random/occ.py DIR [--workers 1] [--most N]

Each verdict is kept as `randomNNNN.occ.json` with the file's hash: a run that was stopped goes on where it
was, and a file that was written anew is read again. Prints the designs that fail and the number of those that
pass; exits with 1 if any fails.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "consumer"))

from OCP.BRepCheck import BRepCheck_Analyzer

import close
import measure
import occ
import topology


def complaints(step: Path) -> list[str]:
    """What is wrong with a file, empty if nothing."""
    expected = json.loads(step.with_suffix(".expected.json").read_text(encoding="utf-8"))
    products = occ.read(step)
    found = []
    if sorted(p.name for p in products) != sorted(expected["genus"]):
        found.append(f"solids {sorted(p.name for p in products)}")
    for product in products:
        shape, name = product.shape, product.name
        if (solids := len(occ.sub_shapes(shape, topology.SOLID))) != 1:
            found.append(f"{name}: {solids} solids")
        if not BRepCheck_Analyzer(shape).IsValid():
            found.append(f"{name}: invalid")
        if free := topology.free_edges(shape):
            found.append(f"{name}: {free} free edges")
        if (tolerance := topology.greatest_tolerance(shape)) > close.TOLERANCE_MM:
            found.append(f"{name}: tolerance {tolerance:.1e} mm")
        if (genus := topology.genus(shape)) != expected["genus"].get(name):
            found.append(f"{name}: genus {genus}, expected {expected['genus'].get(name)}")
        try:
            close.assert_volume(measure.volume_adaptive(shape), expected["volume_mm3"][name], name)
        except AssertionError as error:
            found.append(str(error))
    return found


def kept(step: Path) -> Path:
    return step.with_suffix(".occ.json")


def digest(step: Path) -> str:
    return hashlib.sha256(step.read_bytes()).hexdigest()


def verdict(step: Path) -> list[str] | None:
    """What was found wrong with the file as it is now; none if it has not been read."""
    try:
        known = json.loads(kept(step).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    return known["wrong"] if known["sha256"] == digest(step) else None


def job(step: Path) -> tuple[Path, list[str]]:
    read = digest(step)
    try:
        wrong = complaints(step)
    except Exception as error:
        wrong = [repr(error)]
    # Whole or not at all: a run may be stopped here.
    part = step.with_suffix(".occ.part")
    part.write_text(json.dumps({"sha256": read, "wrong": wrong}) + "\n", encoding="utf-8")
    part.replace(kept(step))
    return step, wrong


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--most", type=int, default=None, help="files to read in this run")
    options = parser.parse_args()
    steps = sorted(options.folder.glob("random*.step"))
    if not steps:
        sys.exit(f"no STEP files in {options.folder}")
    found = {step: verdict(step) for step in steps}
    todo = [step for step in steps if found[step] is None][: options.most]
    with ProcessPoolExecutor(options.workers) as pool:
        for step, wrong in pool.map(job, todo):
            found[step] = wrong
            for what in wrong:
                print(f"{step.stem}: {what}", flush=True)
    known = [wrong for wrong in found.values() if wrong is not None]
    wrong = sum(map(bool, known))
    print(
        f"{len(known) - wrong} of {len(known)} files read hold one valid, closed solid a product, of the"
        f" expected genus and volume; {len(steps) - len(known)} files are not read yet"
    )
    for step, what in found.items():
        if what and step not in todo:
            print(f"{step.stem}, read before: {'; '.join(what)}")
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()
