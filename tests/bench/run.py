#!/usr/bin/env python3
"""`coolinggen` beside the build123d script on the same blade, in one run, on one core.

    tests/.venv/bin/python tests/bench/run.py [DESIGN.json] [--runs 5] [--core 0] [--least 50]

The time of coolinggen is the report's `timings_ms.total` of `inspect --json`: design to solids and report, no
files. The time of the script is its modelling in processor seconds: no imports, volumes or files, no waiting
on a busy machine. Runs alternate; medians count.
Without --least the ratio is only printed; with it, a smaller ratio is an error.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
BINARY = Path(os.environ.get("COOLINGGEN", REPOSITORY / "target/release/coolinggen"))


def answer(core: int, *command) -> dict:
    """What a command pinned to one core printed as JSON."""
    pinned = ["taskset", "--cpu-list", str(core), *map(str, command)]
    done = subprocess.run(pinned, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{command[0]} failed with {done.returncode}:\n{done.stdout}{done.stderr}")
    return json.loads(done.stdout)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("design", type=Path, nargs="?", default=REPOSITORY / "samples/rotor.json")
    parser.add_argument(
        "--runs", type=int, default=5, help="of the script; coolinggen runs four times as often"
    )
    parser.add_argument("--core", type=int, default=min(os.sched_getaffinity(0)))
    parser.add_argument("--least", type=float, help="smallest ratio allowed")
    options = parser.parse_args()

    ours, theirs = [], []
    for _ in range(options.runs):
        for _ in range(4):
            ours.append(answer(options.core, BINARY, "inspect", options.design, "--json"))
        theirs.append(answer(options.core, sys.executable, HERE / "rotor_peer.py", options.design))

    our_ms = [report["timings_ms"]["total"] for report in ours]
    their_ms = [1000 * record["total_s"] for record in theirs]
    ratio = statistics.median(their_ms) / statistics.median(our_ms)
    print(f"{'':12}{'median':>12}{'least':>12}{'greatest':>12}   ms")
    for name, times in (("coolinggen", our_ms), ("build123d", their_ms)):
        print(f"{name:12}{statistics.median(times):12.1f}{min(times):12.1f}{max(times):12.1f}")
    stages = theirs[-1]["seconds"]
    print("build123d:", ", ".join(f"{stage} {1000 * seconds:.0f}" for stage, seconds in stages.items()))
    print(f"{'volumes':12}{'coolinggen':>12}{'build123d':>12}   mm3")
    for name, volume in volumes(ours[-1]).items():
        print(f"{name:12}{volume:12.1f}{theirs[-1]['volume_mm3'][name]:12.1f}")
    print(f"valid by OpenCASCADE: {theirs[-1]['valid']}; ratio {ratio:.1f}")
    if options.least and ratio < options.least:
        sys.exit(f"the ratio is below {options.least}")


def volumes(report: dict) -> dict[str, float]:
    solids = {name: values["volume_mm3"] for name, values in report["solids"].items()}
    metal = solids.pop("metal")
    return {"blank": report["blank"]["volume_mm3"], "metal": metal, "coolant": sum(solids.values())}


if __name__ == "__main__":
    main()
