#!/usr/bin/env python3
"""Builds every sample and draws it: docs/gallery/<sample>.png; and some as whole rows: <sample>-row.png,
or with their inlets extended: <sample>-inlets.png.

    tests/.venv-render/bin/python tests/render/gallery.py [--samples rotor,c3x] [--out docs/gallery]

Uses the binary that COOLINGGEN names, or target/release/coolinggen.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from picture import Stage, save
from solids import Solid, read

REPOSITORY = Path(__file__).resolve().parents[2]
BINARY = Path(os.environ.get("COOLINGGEN", REPOSITORY / "target/release/coolinggen"))
AZIMUTH, ELEVATION, CUT, WIDTH = 30, 28, 0.5, 1600
ROWS = {
    "francis": {"count": 13, "hub": {"thickness": 8}, "shroud": {"thickness": 6}},
    "kaplan": {"count": 4, "hub": {"thickness": 10}},
    "medial-propeller": {"count": 4, "hub": {"thickness": 4}},
    "propeller": {"count": 3, "hub": {"thickness": 8}},
}
#: Lengths of inlet extensions, mm.
INLETS = {"vane-insert": 50}


def built(design: Path) -> list[Solid]:
    """The solids of a design."""
    with tempfile.TemporaryDirectory() as folder:
        command = [BINARY, "generate", design, "--out", folder, "--format", "glb", "--solids", "assembly"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"{design.name}: exit {done.returncode}\n{done.stdout}{done.stderr}")
        return read(sorted(Path(folder).glob("*.glb")))


def draw(design: Path, out: Path) -> None:
    solids = built(design)
    cooled = any(not solid.is_metal for solid in solids)
    inside = "open" if any(solid.is_insert for solid in solids) else "cut"
    views = ["glass", inside, "coolant"] if cooled else ["metal"]
    save(Stage(solids, AZIMUTH, ELEVATION).shoot(views, CUT, WIDTH if cooled else WIDTH // 2), out)


def changed(design: Path, change: Callable[[dict], None]) -> list[Solid]:
    """The solids of a design with a change."""
    document = json.loads(design.read_text(encoding="utf-8"))
    change(document)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / design.name
        path.write_text(json.dumps(document), encoding="utf-8")
        return built(path)


def draw_row(design: Path, pattern: dict, out: Path) -> None:
    """The row of a sample: as it is, and cut through its axis."""
    solids = changed(design, lambda document: document.update(pattern=pattern))
    save(Stage(solids, 40, 24, along_axis=True).shoot(["row", "half"], CUT, WIDTH), out)


def draw_inlets(design: Path, length: float, out: Path) -> None:
    """A sample whose coolant goes on below the hub: through the metal, and alone."""
    solids = changed(design, lambda document: document["cooling"].update(inlet_extension=length))
    save(Stage(solids, AZIMUTH, ELEVATION).shoot(["glass", "coolant"], CUT, WIDTH), out)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--samples", help="names, all without it")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "docs/gallery")
    options = parser.parse_args()
    names = options.samples.split(",") if options.samples else None
    options.out.mkdir(parents=True, exist_ok=True)
    for design in sorted((REPOSITORY / "samples").glob("*.json")):
        if names is None or design.stem in names:
            draw(design, options.out / f"{design.stem}.png")
            print(options.out / f"{design.stem}.png")
    for stem, pattern in ROWS.items():
        row = f"{stem}-row"
        if names is None or row in names:
            draw_row(REPOSITORY / f"samples/{stem}.json", pattern, options.out / f"{row}.png")
            print(options.out / f"{row}.png")
    for stem, length in INLETS.items():
        inlets = f"{stem}-inlets"
        if names is None or inlets in names:
            draw_inlets(REPOSITORY / f"samples/{stem}.json", length, options.out / f"{inlets}.png")
            print(options.out / f"{inlets}.png")


if __name__ == "__main__":
    main()
