"""The designs that the add-on brings with it."""

import json
from pathlib import Path


def _templates() -> list[tuple[str, str]]:
    found = []
    for path in sorted((Path(__file__).parent / "templates").glob("*.json")):
        design = json.loads(path.read_text(encoding="utf-8"))
        found.append((path.stem, design.get("description") or ""))
    return found


#: Name and description of each.
TEMPLATES = _templates()
