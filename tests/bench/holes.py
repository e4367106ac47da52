#!/usr/bin/env python3
"""Film holes in `rotor.json`: what they cost `coolinggen`, and the same holes cut by OpenCASCADE in one
batch.

    tests/.venv/bin/python tests/bench/holes.py [--peer 100 400] [--counts 25 50 ... 1600] [--core 0]

Prints processor milliseconds of `inspect --json`, the whole process, least of several runs, for each
number of holes, and the exponent p of cost ~ N^p that fits the cost above that of the blade without
holes. For the numbers in --peer the blade is modelled with build123d (rotor_peer.py) and round cutters
at the reported places are taken from it with one BRepAlgoAPI_Cut; the ratio is that of the whole blade
with holes, processor seconds of the script over those of coolinggen, alternating on one core.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from run import BINARY, HERE, REPOSITORY, answer

DIAMETER = 0.25
# Fractions of the sides over the chambers of rotor.json, clear of its walls.
PLACES = {
    "suction_side": [(0.06, 0.2), (0.42, 0.54), (0.68, 0.8)],
    "pressure_side": [(0.12, 0.24), (0.44, 0.56), (0.7, 0.8)],
}
SPAN = [0.14, 0.86]


def places(rows: int) -> list[tuple[str, float]]:
    """Rows spread over both sides and all chambers."""
    out = []
    for number in range(rows):
        side = ("suction_side", "pressure_side")[number % 2]
        ranges = PLACES[side]
        low, high = ranges[number // 2 % len(ranges)]
        step = number // 2 // len(ranges)
        most = (rows + 1) // 2 // len(ranges) + 1
        out.append((side, low + (high - low) * (step + 0.5) / most))
    return out


def design(holes: int, folder: Path) -> Path:
    """rotor.json with this many holes of 0.25 mm in rows of at most 40."""
    document = json.loads((REPOSITORY / "samples/rotor.json").read_text(encoding="utf-8"))
    rows = max(1, holes // 40) if holes else 0
    document["cooling"]["film_rows"] = [
        {
            "name": f"r{number}",
            "side": side,
            "surface_position": place,
            "span": SPAN,
            "count": holes // rows + (number < holes % rows),
            "hole": {"diameter": DIAMETER, "inclination_deg": 60},
        }
        for number, (side, place) in enumerate(places(rows))
    ]
    path = folder / f"holes{holes}.json"
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


def timed(core: int, path: Path, runs: int) -> tuple[float, dict]:
    """Least processor milliseconds of `inspect` on this design, and its report."""
    times = []
    for _ in range(runs):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        report = answer(core, BINARY, "inspect", path, "--json")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        times.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return 1000 * min(times), report


def peer(path: Path, holes: list[dict]) -> None:
    """In a process of its own: the blade of rotor_peer.py less a cylinder for each hole; prints a record."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

    import rotor_peer

    watch = rotor_peer.Stopwatch()
    _, _, metal = rotor_peer.model(json.loads(path.read_text(encoding="utf-8")), watch)
    start = time.process_time()
    tools = []
    for hole in holes:
        direction, exit_ = np.array(hole["direction"]), np.array(hole["position_mm"])
        reach = hole["length_mm"] + 2 * hole["diameter_mm"]
        foot = exit_ - direction * (hole["length_mm"] + hole["diameter_mm"])
        axis = gp_Ax2(gp_Pnt(*map(float, foot)), gp_Dir(*map(float, direction)))
        tools.append(BRepPrimAPI_MakeCylinder(axis, hole["diameter_mm"] / 2, reach).Shape())
    drilled = rotor_peer.boolean(BRepAlgoAPI_Cut(), [metal], tools)
    drill = time.process_time() - start
    print(
        json.dumps(
            {
                "blade_s": sum(watch.seconds.values()),
                "drill_s": drill,
                "faces_added": len(rotor_peer.faces(drilled)) - len(rotor_peer.faces(metal)),
                "valid": BRepCheck_Analyzer(drilled).IsValid(),
            }
        )
    )


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--counts", type=int, nargs="*", default=[25, 50, 100, 200, 400, 800, 1600])
    parser.add_argument("--peer", type=int, nargs="*", default=[100, 400])
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--core", type=int, default=min(os.sched_getaffinity(0)))
    parser.add_argument("--as-peer", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.as_peer:
        design_path, report_path = map(Path, options.as_peer)
        peer(design_path, json.loads(report_path.read_text(encoding="utf-8")))
        return
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        least, reports = {}, {}
        for count in [0, *options.counts]:
            path = design(count, folder)
            least[count], report = timed(options.core, path, options.runs)
            reports[count] = report
            found = len(report.get("holes", []))
            print(
                f"{count:6} holes {least[count]:10.1f} ms   genus {report['genus']['metal']['found']}",
                flush=True,
            )
            assert found == count
        cost = [(n, least[n] - least[0]) for n in options.counts if least[n] > least[0]]
        slope = np.polyfit(*np.log(np.array(cost)).T, 1)[0]
        print(f"cost of the holes grows with N^{slope:.3f}")
        for count in options.peer:
            path = design(count, folder)
            if count not in reports:
                reports[count] = answer(options.core, BINARY, "inspect", path, "--json")
            holes = folder / f"places{count}.json"
            holes.write_text(json.dumps(reports[count]["holes"]), encoding="utf-8")
            record = answer(options.core, sys.executable, HERE / "holes.py", "--as-peer", path, holes)
            ours, _ = timed(options.core, path, options.runs)
            theirs = 1000 * (record["blade_s"] + record["drill_s"])
            print(
                f"{count:6} holes: build123d {theirs:.0f} ms (blade {1000 * record['blade_s']:.0f}, holes "
                f"{1000 * record['drill_s']:.0f}; {record['faces_added']} faces more, valid "
                f"{record['valid']}), coolinggen {ours:.1f} ms: {theirs / ours:.0f} times",
                flush=True,
            )


if __name__ == "__main__":
    main()
