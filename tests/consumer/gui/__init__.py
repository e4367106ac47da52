"""FreeCAD's window under Xvfb: installs the add-on as a user would, plays scenarios, says how they went."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
ROOT = Path(__file__).parents[3]


def install(home: Path, binary: Path) -> None:
    """Installs the add-on with this binary for a user whose FreeCAD folder is ``home``."""
    package = [sys.executable, ROOT / "freecad-addon" / "package.py", home / "Mod", "--binary", binary]
    subprocess.run(package, check=True, stdout=subprocess.DEVNULL)


def play(
    folder: Path,
    home: Path,
    scenarios: list[Path],
    wanted: str = "",
    patience_s: float = 60,
    limit_s: float = 400,
) -> dict:
    """Plays scenarios of these files in FreeCAD's window; pictures come into ``folder``, the result has for
    each scenario ``error``, ``notes`` and ``seconds``.

    In ``folder`` FreeCAD has two more, where the system lets a user mount them: ``read-only`` and ``full``.
    """
    folder.mkdir(parents=True, exist_ok=True)
    environment = {
        "HOME": str(home),
        "LANG": "C.UTF-8",
        "PATH": "/usr/bin:/bin",
        "FREECAD_USER_HOME": str(home),
        "QTWEBENGINE_DISABLE_SANDBOX": "1",
        "COOLINGGEN_GUI_FOLDER": str(folder),
        "COOLINGGEN_GUI_SCENARIOS": os.pathsep.join(map(str, scenarios)),
        "COOLINGGEN_GUI_WANTED": wanted,
        "COOLINGGEN_GUI_PATIENCE": str(patience_s),
    }
    with tempfile.TemporaryDirectory(prefix="xvfb-") as place, (folder / "log.txt").open("w") as log:
        number, seen = os.pipe()
        server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(seen), "-screen", "0", "1400x900x24", "-nolisten", "tcp"],
            pass_fds=[seen],
            cwd=place,
            stdout=log,
            stderr=log,
        )
        os.close(seen)
        try:
            with os.fdopen(number) as told:
                display = told.readline().strip()
            subprocess.run(
                [*_refusing(folder), "freecad", HERE / "driver.py"],
                cwd=place,
                env={**environment, "DISPLAY": f":{display}"},
                stdout=log,
                stderr=log,
                stdin=subprocess.DEVNULL,
                timeout=limit_s,
                check=False,
            )
        finally:
            server.terminate()
            server.wait()
    told = folder / "told.json"
    if not (folder / "done").is_file():
        raise AssertionError(
            f"FreeCAD ended early:\n{(folder / 'log.txt').read_text(errors='replace')[-3000:]}"
        )
    return json.loads(told.read_text(encoding="utf-8"))


def _refusing(folder: Path) -> list[str | Path]:
    """What makes the folders that refuse files for a command behind it; nothing if that cannot be."""
    for name in ("read-only", "full"):
        (folder / name).mkdir(exist_ok=True)
    mount = (
        'mount -t tmpfs -o ro,size=16k tmpfs "$0/read-only" && mount -t tmpfs -o size=16k tmpfs "$0/full" '
        '&& exec "$@"'
    )
    command = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", mount, folder]
    works = subprocess.run([*command, "true"], check=False, capture_output=True).returncode == 0
    return command if works else []
