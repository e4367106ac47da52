"""The add-ons' client in hosts that treat signals otherwise than Python does."""

import subprocess
import sys

import cli

#: A host with SIGPIPE at its default, as FreeCAD 1.0 leaves it, that writes only when nobody reads any more.
HOST = """
import signal, subprocess, sys, time
from pathlib import Path
from client import sidecar

class Late(subprocess.Popen):
    def __init__(self, *arguments, **more):
        super().__init__(*arguments, **more)
        time.sleep(0.5)

signal.signal(signal.SIGPIPE, signal.SIG_DFL)
subprocess.Popen = Late
try:
    sidecar.Sidecar(Path(sys.argv[1]), "host")
except sidecar.MissingError as error:
    print("told:", error)
"""


def test_a_host_outlives_a_program_that_has_ended(tmp_path):
    program = tmp_path / "coolinggen"
    program.write_text("#!/bin/sh\nexec <&-\nsleep 1\n", encoding="utf-8")
    program.chmod(0o755)
    folder = cli.REPOSITORY / "freecad-addon" / "freecad" / "coolinggen"
    command = [sys.executable, "-c", HOST, program]
    host = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert host.returncode == 0, host
    assert host.stdout.startswith("told:"), host
