#!/usr/bin/env python3
"""An installable add-on with the binary of this platform: ``package.py FOLDER`` writes FOLDER/CoolingGen,
which goes as it is into FreeCAD's ``Mod`` folder. Build the binary first: ``cargo build --release``."""

import argparse
import os
import shutil
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def package(folder: Path, binary: Path) -> Path:
    """The add-on's folder inside ``folder``; what is there of an older one is replaced."""
    made = folder / "CoolingGen"
    shutil.rmtree(made, ignore_errors=True)
    shutil.copytree(
        ROOT / "freecad-addon",
        made / "freecad-addon",
        ignore=shutil.ignore_patterns("__pycache__", "package.py"),
    )
    for name in ("package.xml", "LICENSE-MIT", "LICENSE-APACHE"):
        shutil.copy(ROOT / name, made)
    place = made / "freecad-addon" / "freecad" / "coolinggen" / "bin"
    place.mkdir()
    shutil.copy(binary, place / f"coolinggen{binary.suffix if binary.suffix == '.exe' else ''}")
    return made


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    suffix = ".exe" if os.name == "nt" else ""
    built = ROOT / "target" / "release" / f"coolinggen{suffix}"
    parser.add_argument("--binary", type=Path, default=built, help="the built binary (%(default)s)")
    options = parser.parse_args()
    if not options.binary.is_file():
        parser.error(f"there is no {options.binary}: build it first, cargo build --release")
    print(package(options.folder, options.binary))


if __name__ == "__main__":
    main()
