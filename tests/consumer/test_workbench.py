"""The FreeCAD workbench, packaged and installed as a user would, in its own document tests."""

from __future__ import annotations

import os
import re
import subprocess

import cli
import gui


def test_installed_addon(tmp_path):
    home = tmp_path / "home of the user"
    gui.install(home, cli.BINARY)
    run = subprocess.run(
        ["freecadcmd", "-t", "freecad.coolinggen.tests.test_document"],
        cwd=tmp_path,
        env={**os.environ, "FREECAD_USER_HOME": str(home), "PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        timeout=900,
    )
    told = run.stdout + run.stderr
    assert run.returncode == 0, told
    # FreeCAD's own code of return says nothing of a module that it could not load.
    ran = re.search(r"^Ran (\d+) tests", told, re.MULTILINE)
    assert ran and int(ran[1]) >= 12 and re.search(r"^OK$", told, re.MULTILINE), told
