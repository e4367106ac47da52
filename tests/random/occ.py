#!/usr/bin/env python3
"""OpenCASCADE on what `coolinggen-random --out DIR` wrote: every solid valid, closed, of the expected genus
and volume.

    tests/.venv/bin/python tests/random/occ.py DIR [--workers 2]

Prints the designs that fail and the number of those that pass; exits with 1 if any fails.
"""

from __future__ import annotations

import argparse
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


def job(step: Path) -> tuple[Path, list[str]]:
    try:
        return step, complaints(step)
    except Exception as error:
        return step, [repr(error)]


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--workers", type=int, default=2)
    options = parser.parse_args()
    steps = sorted(options.folder.glob("random*.step"))
    if not steps:
        sys.exit(f"no STEP files in {options.folder}")
    wrong = 0
    with ProcessPoolExecutor(options.workers) as pool:
        for step, found in pool.map(job, steps, chunksize=4):
            wrong += bool(found)
            for what in found:
                print(f"{step.stem}: {what}", flush=True)
    print(f"{len(steps) - wrong} of {len(steps)} files are valid, closed, of the expected genus and volume")
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()
