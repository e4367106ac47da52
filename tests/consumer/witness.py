"""Outside programs that look at STEP files in processes of their own, beside the other tests.

Great files have a process each, since FreeCAD's check takes minutes on a blade with a hundred holes; small
ones share a process a core. Each writes one JSON line a file as soon as it is done with it: a crash, or a
process that has run out of time, is blamed on the file that it happened on, and the files before it keep
their findings.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import NoReturn

import pytest

HERE = Path(__file__).resolve().parent


ALONE = 1_000_000  # bytes of a file from which on it has a process of its own
GREAT = 5_000_000  # bytes of a file from which on a check takes minutes: some hundred bores
LONG = bool(os.environ.get("COOLINGGEN_LONG"))  # whether there is time for them, see tests/run
LIMIT = 7200 if LONG else 900  # seconds for a process: what takes longer is a failure


def too_great(step: Path) -> bool:
    """Whether a file's long checks are left to `tests/run --long`."""
    return not LONG and step.stat().st_size >= GREAT


def leave_to_long(what: object) -> NoReturn:
    """Skips a test, saying where it is run."""
    pytest.skip(f"{what}: takes minutes, run by tests/run --long")


class Findings:
    """What is found, some of it still to come."""

    def __init__(self, coming: dict[Path, Future[tuple[str, str]]]):
        self._coming = coming

    def of(self, step: Path) -> dict:
        """What was found for this file, once it is; a fault of the program itself is an assertion error."""
        if step not in self._coming:
            leave_to_long(step.name)
        lines, output = self._coming[step].result()
        for entry in map(json.loads, lines.splitlines()):
            if entry.pop("file") == str(step):
                if "error" in entry:
                    raise AssertionError(f"{step.name}: {entry['error']}")
                return entry
        raise AssertionError(f"no answer for {step.name}; the program said:\n{output[-3000:]}")


def freecad(steps: list[Path], folder: Path) -> Findings:
    """`freecadcmd` with a home folder of its own, so that no settings matter; it always exits with 0."""
    program = next(filter(None, map(shutil.which, ("freecadcmd", "FreeCADCmd"))), None)
    if program is None:
        raise AssertionError("freecadcmd is missing: run tests/install")
    return _ask([program, str(HERE / "freecad_witness.py")], steps, folder)


def gmsh(steps: list[Path], folder: Path) -> Findings:
    """In a process of its own: Gmsh brings its own OpenCASCADE, which must not meet the one of build123d."""
    small = [step for step in steps if not too_great(step)]
    return _ask([sys.executable, str(HERE / "gmsh_witness.py")], small, folder)


def _ask(command: list[str], steps: list[Path], folder: Path) -> Findings:
    """Starts the processes, as many at a time as there are cores, those of the greatest files first."""

    def size(step: Path) -> int:
        return step.stat().st_size

    ordered = sorted(steps, key=size, reverse=True)
    cores = os.cpu_count() or 1
    shared: list[list[Path]] = [[] for _ in range(cores)]
    for step in (step for step in ordered if size(step) < ALONE):
        min(shared, key=lambda share: sum(map(size, share))).append(step)
    shares = [[step] for step in ordered if size(step) >= ALONE] + [share for share in shared if share]
    pool = ThreadPoolExecutor(cores)
    coming = {}
    for number, share in enumerate(shares):
        answer = pool.submit(_work, command, share, folder / f"share{number}")
        coming.update(dict.fromkeys(share, answer))
    pool.shutdown(wait=False)
    return Findings(coming)


def _work(command: list[str], steps: list[Path], folder: Path) -> tuple[str, str]:
    """One process: the lines it wrote, and what it said."""
    jobs, answers, home = folder / "jobs.json", folder / "answers.jsonl", folder / "home"
    home.mkdir(parents=True)
    jobs.write_text(json.dumps([[str(step), too_great(step)] for step in steps]), encoding="utf-8")
    answers.touch()
    environment = {"WITNESS_JOBS": str(jobs), "WITNESS_ANSWERS": str(answers), "FREECAD_USER_HOME": str(home)}
    said = folder / "output.txt"
    with said.open("wb") as output:
        try:
            subprocess.run(
                command,
                stdout=output,
                stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL,
                env={**os.environ, **environment},
                timeout=LIMIT,
                check=False,
            )
        except subprocess.TimeoutExpired:
            output.write(f"\nended after {LIMIT} s".encode())
    return answers.read_text(encoding="utf-8"), said.read_text(encoding="utf-8", errors="replace")
