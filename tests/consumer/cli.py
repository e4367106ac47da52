"""Runs the `coolinggen` binary the way a user does, and finds what it wrote."""

from __future__ import annotations

import json
import os
import subprocess
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
BINARY = Path(os.environ.get("COOLINGGEN", REPOSITORY / "target/release/coolinggen")).resolve()
SAMPLES = Path(os.environ.get("COOLINGGEN_SAMPLES", REPOSITORY / "samples")).resolve()
#: Formats of files a part, with what the files' names end with, and those of one file for all parts.
FORMATS = {
    "step": "step",
    "step_ap242": "ap242.step",
    "brep": "brep",
    "iges": "igs",
    "iges_surfaces": "surfaces.igs",
    "glb": "glb",
    "obj": "obj",
    "stl": "stl",
    "nastran": "nas",
}
WHOLE = {"gmsh": "gmsh.py", "openfoam": "openfoam"}

DONE, OTHER, REFUSED = 0, 1, 2


def samples() -> list[Path]:
    return sorted(SAMPLES.glob("*.json"))


def run(*arguments, timeout: float = 300, **environment: str) -> subprocess.CompletedProcess[str]:
    """One call of the binary. The text is decoded leniently, so that a test can show whatever came out."""
    return subprocess.run(
        [BINARY, *map(str, arguments)],
        capture_output=True,
        text=True,
        errors="replace",
        timeout=timeout,
        stdin=subprocess.DEVNULL,
        env={**os.environ, **environment},
        check=False,
    )


def generate(
    design: Path, folder: Path, *options: str, **environment: str
) -> subprocess.CompletedProcess[str]:
    formats = ",".join([*FORMATS, *WHOLE])
    return run("generate", design, "--out", folder, "--format", formats, *options, **environment)


@dataclass(frozen=True)
class Model:
    """What `generate` wrote for one design."""

    design_path: Path
    folder: Path

    @cached_property
    def design(self) -> dict:
        return json.loads(self.design_path.read_text(encoding="utf-8"))

    @property
    def name(self) -> str:
        return self.design["name"]

    @cached_property
    def report(self) -> dict:
        return json.loads((self.folder / f"{self.name}.report.json").read_text(encoding="utf-8"))

    @cached_property
    def manifest(self) -> dict:
        return json.loads((self.folder / f"{self.name}.groups.json").read_text(encoding="utf-8"))

    @cached_property
    def parts(self) -> list[str]:
        """`metal` and `coolant`, each with its files; the coolant is a solid, `coolant/...`, a passage."""
        return list(dict.fromkeys(map(part_of, self.report["solids"])))

    def file(self, part: str, extension: str) -> Path:
        """The file of one part, or of all of them for the part named `assembly`."""
        return self.folder / f"{self.name}.{part}.{extension}"

    def solids(self, part: str) -> list[str]:
        return [name for name in self.report["solids"] if part_of(name) == part]

    def in_order(self, part: str) -> list[str]:
        """The same, as they stand in the files."""
        return [solid["name"] for solid in self.manifest["solids"] if part_of(solid["name"]) == part]

    def total(self, part: str, value: str) -> float:
        """A value of the report's solids, summed up over the part."""
        return sum(self.report["solids"][name][value] for name in self.solids(part))

    def genus(self, part: str) -> int:
        return sum(self.report["genus"][name]["expected"] for name in self.solids(part))

    def box(self, part: str) -> list[list[float]]:
        boxes = [self.report["solids"][name]["bounding_box_mm"] for name in self.solids(part)]
        low = [min(values) for values in zip(*(box["min"] for box in boxes), strict=True)]
        high = [max(values) for values in zip(*(box["max"] for box in boxes), strict=True)]
        return [low, high]

    def faces(self, part: str) -> list[dict]:
        return [face for face in self.report["faces"] if part in map(part_of, face["solids"])]

    def face_names(self, part: str) -> set[str]:
        return {face["name"] for face in self.faces(part)}


def part_of(solid: str) -> str:
    return solid.split("/")[0]


def build(design: Path, folder: Path) -> Model:
    """Generates a design that has to be built; anything else ends the test with what was printed."""
    done = generate(design, folder)
    if done.returncode != DONE:
        raise AssertionError(f"{design.name}: exit {done.returncode}\n{done.stdout}\n{done.stderr}")
    return Model(design, folder)
