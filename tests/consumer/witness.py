"""Outside programs that look at many STEP files in one process of their own.

Each writes one JSON line a file as soon as it is done with it, so that a crash is blamed on the file that it
happened on, and the files before it keep their findings.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent


class Findings:
    def __init__(self, lines: str, output: str):
        self._by_file = {}
        for line in lines.splitlines():
            entry = json.loads(line)
            self._by_file[entry.pop("file")] = entry
        self._output = output

    def of(self, step: Path) -> dict:
        """What was found for this file; a fault of the program itself is an assertion error."""
        found = self._by_file.get(str(step))
        if found is None:
            raise AssertionError(f"no answer for {step.name}; the program said:\n{self._output[-3000:]}")
        if "error" in found:
            raise AssertionError(f"{step.name}: {found['error']}")
        return found


def freecad(steps: list[Path], folder: Path) -> Findings:
    """`freecadcmd` with a home folder of its own, so that no settings matter; it always exits with 0."""
    program = next(filter(None, map(shutil.which, ("freecadcmd", "FreeCADCmd"))), None)
    if program is None:
        raise AssertionError("freecadcmd is missing: run tests/install")
    return _ask([program, str(HERE / "freecad_witness.py")], steps, folder)


def gmsh(steps: list[Path], folder: Path) -> Findings:
    """In a process of its own: Gmsh brings its own OpenCASCADE, which must not meet the one of build123d."""
    return _ask([sys.executable, str(HERE / "gmsh_witness.py")], steps, folder)


def _ask(command: list[str], steps: list[Path], folder: Path) -> Findings:
    """A process a core; the greatest files are dealt out first."""
    shares: list[list[Path]] = [[] for _ in range(min(len(steps), os.cpu_count() or 1))]
    for step in sorted(steps, key=lambda step: step.stat().st_size, reverse=True):
        min(shares, key=lambda share: sum(s.stat().st_size for s in share)).append(step)
    with ThreadPoolExecutor() as pool:
        found = list(
            pool.map(lambda job: _work(command, job[1], folder / f"share{job[0]}"), enumerate(shares))
        )
    return Findings("".join(lines for lines, _ in found), "\n".join(output for _, output in found))


def _work(command: list[str], steps: list[Path], folder: Path) -> tuple[str, str]:
    """One process: the lines it wrote, and what it said."""
    jobs, answers, home = folder / "jobs.json", folder / "answers.jsonl", folder / "home"
    home.mkdir(parents=True)
    jobs.write_text(json.dumps([str(step) for step in steps]), encoding="utf-8")
    answers.touch()
    environment = {"WITNESS_JOBS": str(jobs), "WITNESS_ANSWERS": str(answers), "FREECAD_USER_HOME": str(home)}
    done = subprocess.run(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        stdin=subprocess.DEVNULL,
        env={**os.environ, **environment},
        timeout=1800,
        check=False,
    )
    return answers.read_text(encoding="utf-8"), done.stdout
