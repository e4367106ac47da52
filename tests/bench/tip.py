#!/usr/bin/env python3
"""The pointed tips of the propeller samples at many tolerances of the skin: FreeCAD's check and the meshes.

    tests/.venv/bin/python tests/bench/tip.py [--tolerances 0.0005,0.002,0.02]

Prints a table; a complaint of FreeCAD's BOP check, an open mesh or a normal that looks inward is an error.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from run import BINARY, HERE, REPOSITORY

sys.path.insert(0, str(HERE.parent / "consumer"))

import meshes

SAMPLES = ("propeller", "medial-propeller")
TOLERANCES = "0.0005,0.0007,0.001,0.0014,0.0018,0.002,0.0025,0.003,0.004,0.005,0.007,0.01,0.014,0.02"


def generate(folder: Path, sample: str, tolerance: float) -> Path:
    """Builds a sample with another tolerance; the folder of its files."""
    design = json.loads((REPOSITORY / f"samples/{sample}.json").read_text(encoding="utf-8"))
    design["blade"]["skin"] = {"tolerance": tolerance}
    out = folder / f"{sample}-{tolerance}"
    out.mkdir()
    path = out / "design.json"
    path.write_text(json.dumps(design), encoding="utf-8")
    command = [BINARY, "generate", path, "--out", out, "--format", "step,glb", "--solids", "metal"]
    subprocess.run(list(map(str, command)), check=True, capture_output=True)
    return out


def checked(folder: Path, steps: list[Path]) -> dict[str, dict]:
    """What FreeCAD says of the files."""
    jobs, answers = folder / "jobs.json", folder / "answers.jsonl"
    jobs.write_text(json.dumps([(str(step), False) for step in steps]), encoding="utf-8")
    environment = {**os.environ, "WITNESS_JOBS": str(jobs), "WITNESS_ANSWERS": str(answers)}
    witness = HERE.parent / "consumer/freecad_witness.py"
    subprocess.run(["freecadcmd", str(witness)], env=environment, check=True, capture_output=True)
    rows = map(json.loads, answers.read_text(encoding="utf-8").splitlines())
    return {row["file"]: row for row in rows}


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--tolerances", default=TOLERANCES)
    tolerances = [float(t) for t in parser.parse_args().tolerances.split(",")]
    bad = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        cases = [(s, t, generate(folder, s, t)) for s in SAMPLES for t in tolerances]
        found = checked(folder, [next(out.glob("*.step")) for _, _, out in cases])
        print(f"{'sample':20}{'tolerance':>10}{'BOP':>8}{'triangles':>11}{'open':>6}{'inward':>8}")
        for sample, tolerance, out in cases:
            faults = [f for thing in found[str(next(out.glob("*.step")))]["objects"] for f in thing["bop"]]
            regions = [r for node in meshes.read_glb(next(out.glob("*.glb"))) for r in node.regions]
            count = sum(len(region.corners) for region in regions)
            opened, inward = meshes.sides_not_paired(regions), meshes.normals_turned_away(regions)
            bad += bool(faults) + bool(opened) + bool(inward)
            print(f"{sample:20}{tolerance:10}{len(faults) or 'clean':>8}{count:11}{opened:6}{inward:8}")
    if bad:
        sys.exit(f"{bad} faults")


if __name__ == "__main__":
    main()
