#!/usr/bin/env python3
"""Builds every sample and draws it: docs/gallery/<sample>.png.

    tests/.venv-render/bin/python tests/render/gallery.py [--samples rotor,c3x] [--out docs/gallery]

Uses the binary that COOLINGGEN names, or target/release/coolinggen.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from picture import Stage, save
from solids import read

REPOSITORY = Path(__file__).resolve().parents[2]
BINARY = Path(os.environ.get("COOLINGGEN", REPOSITORY / "target/release/coolinggen"))
AZIMUTH, ELEVATION, CUT, WIDTH = 30, 28, 0.5, 1600


def draw(design: Path, out: Path) -> None:
    with tempfile.TemporaryDirectory() as folder:
        command = [BINARY, "generate", design, "--out", folder, "--format", "glb", "--solids", "assembly"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"{design.name}: exit {done.returncode}\n{done.stdout}{done.stderr}")
        solids = read(sorted(Path(folder).glob("*.glb")))
    cooled = any(not solid.is_metal for solid in solids)
    inside = "open" if any(solid.is_insert for solid in solids) else "cut"
    views = ["glass", inside, "coolant"] if cooled else ["metal"]
    save(Stage(solids, AZIMUTH, ELEVATION).shoot(views, CUT, WIDTH if cooled else WIDTH // 2), out)


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


if __name__ == "__main__":
    main()
