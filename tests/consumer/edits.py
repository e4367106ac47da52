"""Changes to a design by JSON pointer, for making broken ones."""

from __future__ import annotations

import copy
import json
import math
from pathlib import Path
from typing import Any

REMOVE = object()


def edited(design: dict, changes: dict[str, Any]) -> dict:
    """A copy with the value at each pointer replaced, added or removed; functions get the value there was."""
    result = copy.deepcopy(design)
    for pointer, value in changes.items():
        parent, key = _walk(result, pointer)
        if value is REMOVE:
            del parent[key]
        elif isinstance(parent, list) and key == len(parent):
            parent.append(value)
        else:
            parent[key] = value(parent[key]) if callable(value) else value
    return result


def _walk(design: Any, pointer: str) -> tuple[Any, str | int]:
    *path, last = [part.replace("~1", "/").replace("~0", "~") for part in pointer.split("/")[1:]]
    for part in path:
        design = design[int(part)] if isinstance(design, list) else design[part]
    if isinstance(design, list):
        last = len(design) if last == "-" else int(last)
    return design, last


def text(design: Any) -> str:
    """JSON as Python writes it: NaN and Infinity come out as bare words, which JSON does not know."""
    return json.dumps(design)


def write(path: Path, design: Any) -> Path:
    path.write_text(design if isinstance(design, str) else text(design), encoding="utf-8")
    return path


NAN, INFINITE = math.nan, math.inf
