#!/usr/bin/env python3
"""A medial blade from parameters to STEP beside its surfaces skinned in build123d, in one run on one core.

    tests/.venv/bin/python tests/bench/medial.py [DESIGN.json] [--runs 5] [--core 0] [--least 20]

Both in processor seconds. Those of coolinggen are the whole process: reading the design, building, measuring,
STEP. Those of the script are its modelling from a cloud of points of our surface and its STEP file, without
imports. Runs alternate; medians count. Without --least the ratio is only printed.
"""

from __future__ import annotations

import argparse
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from run import BINARY, HERE, REPOSITORY, answer


def generate(core: int, design: Path, folder: Path) -> float:
    """Processor seconds from the design to the STEP file of its metal."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [BINARY, "generate", design, "--out", folder, "--format", "step", "--solids", "metal"]
    subprocess.run(["taskset", "--cpu-list", str(core), *map(str, command)], check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("design", type=Path, nargs="?", default=REPOSITORY / "samples/francis.json")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--core", type=int, default=min(os.sched_getaffinity(0)))
    parser.add_argument("--least", type=float, help="smallest ratio allowed")
    options = parser.parse_args()
    ours, theirs = [], []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for _ in range(options.runs):
            ours += [generate(options.core, options.design, folder) for _ in range(4)]
            step = next(folder.glob("*.metal.step"))
            peer = [HERE / "medial_peer.py", options.design, step, folder / "peer.step"]
            theirs.append(answer(options.core, sys.executable, *peer))
    our_ms = [1000 * seconds for seconds in ours]
    their_ms = [1000 * record["total_s"] for record in theirs]
    ratio = statistics.median(their_ms) / statistics.median(our_ms)
    print(f"{'':12}{'median':>12}{'least':>12}{'greatest':>12}   processor ms")
    for name, times in (("coolinggen", our_ms), ("build123d", their_ms)):
        print(f"{name:12}{statistics.median(times):12.1f}{min(times):12.1f}{max(times):12.1f}")
    stages = theirs[-1]["seconds"]
    print("build123d:", ", ".join(f"{stage} {1000 * seconds:.0f}" for stage, seconds in stages.items()))
    print(f"build123d: {theirs[-1]['volume_mm3']:.1f} mm3, valid by OpenCASCADE: {theirs[-1]['valid']}")
    print(f"ratio {ratio:.1f}")
    if options.least and ratio < options.least:
        sys.exit(f"the ratio is below {options.least}")


if __name__ == "__main__":
    main()
