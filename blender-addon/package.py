#!/usr/bin/env python3
"""An installable extension with the program of this platform: ``package.py FOLDER`` writes
FOLDER/coolinggen-VERSION-PLATFORM.zip. Build the program first: ``cargo build --release``."""

import argparse
import os
import platform
import shutil
import subprocess
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SUFFIX = ".exe" if os.name == "nt" else ""
CLIENT = ROOT / "freecad-addon" / "freecad" / "coolinggen" / "client"

#: Blender's names of platforms.
PLATFORMS = {
    ("Linux", "x86_64"): "linux-x64",
    ("Linux", "aarch64"): "linux-arm64",
    ("Darwin", "arm64"): "macos-arm64",
    ("Darwin", "x86_64"): "macos-x64",
    ("Windows", "AMD64"): "windows-x64",
    ("Windows", "ARM64"): "windows-arm64",
}


def package(folder: Path, binary: Path) -> Path:
    """The extension's zip inside ``folder``."""
    here = PLATFORMS[platform.system(), platform.machine()]
    with tempfile.TemporaryDirectory() as made:
        addon = Path(made) / "coolinggen"
        ignored = shutil.ignore_patterns("__pycache__", "tests")
        shutil.copytree(ROOT / "blender-addon" / "coolinggen", addon, ignore=ignored)
        shutil.copytree(CLIENT, addon / "client", ignore=ignored)
        (addon / "bin").mkdir()
        shutil.copy(binary, addon / "bin" / f"coolinggen{SUFFIX}")
        schema = subprocess.run([binary, "schema"], check=True, capture_output=True).stdout
        (addon / "schema.json").write_bytes(schema)
        (addon / "templates").mkdir()
        for sample in sorted((ROOT / "samples").iterdir()):
            shutil.copy(sample, addon / "templates")
        for name in ("LICENSE-MIT", "LICENSE-APACHE"):
            shutil.copy(ROOT / name, addon)
        manifest = addon / "blender_manifest.toml"
        text = manifest.read_text(encoding="utf-8")
        version = tomllib.loads(text)["version"]
        manifest.write_text(
            text.replace("\n[permissions]", f'platforms = ["{here}"]\n\n[permissions]'), encoding="utf-8"
        )
        folder.mkdir(parents=True, exist_ok=True)
        return Path(shutil.make_archive(str(folder / f"coolinggen-{version}-{here}"), "zip", addon))


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    built = ROOT / "target" / "release" / f"coolinggen{SUFFIX}"
    parser.add_argument("--binary", type=Path, default=built, help="the built program (%(default)s)")
    options = parser.parse_args()
    if not options.binary.is_file():
        parser.error(f"there is no {options.binary}: build it first, cargo build --release")
    print(package(options.folder, options.binary))


if __name__ == "__main__":
    main()
