"""Makes the pictures of docs/freecad.md again: ``python -m gui`` in tests/consumer."""

import shutil
import tempfile
from pathlib import Path

import cli

from . import HERE, ROOT, install, play

PICTURES = ROOT / "docs" / "freecad"


def main() -> None:
    """Plays the tutorial."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        install(place / "home", cli.BINARY)
        told = play(place / "pictures", place / "home", [HERE / "tutorial.py"])
        PICTURES.mkdir(exist_ok=True)
        for picture in sorted((place / "pictures").glob("*.png")):
            shutil.copy(picture, PICTURES / picture.name)
            print(PICTURES / picture.name)
    for name, scenario in told.items():
        if scenario["error"]:
            raise SystemExit(f"{name}:\n{scenario['error']}")


if __name__ == "__main__":
    main()
