"""Places in a design: paths and JSON pointers, what stands there, names that are taken."""

import itertools
import re
from collections.abc import Iterator
from copy import deepcopy
from typing import Any

#: Stands for "nothing is there".
MISSING: Any = object()

Path = tuple  #: Names and indices that lead to a value of a document.

#: Fields that hold the name of something else in the design, and the list under ``cooling`` where these are.
REFERENCES = {"chamber": "chambers", "between": "chambers", "wall": "walls"}


def unused(names: tuple[str, ...], wanted: str) -> str:
    """``wanted``, or with a number that makes it new."""
    if wanted not in names:
        return wanted
    numbered = re.fullmatch(r"(.*?)(\d+)", wanted)
    stem, number = (numbered[1], int(numbered[2])) if numbered else (f"{wanted}_", 1)
    return next(made for k in itertools.count(number + 1) if (made := f"{stem}{k}") not in names)


def pointer(path: Path) -> str:
    """JSON pointer of a path."""
    return "".join("/" + str(step).replace("~", "~0").replace("/", "~1") for step in path)


def path(pointer: str) -> Path:
    """Path of a JSON pointer; indices are numbers."""
    steps = [step.replace("~1", "/").replace("~0", "~") for step in pointer.split("/")[1:]]
    return tuple(int(step) if step.isdigit() else step for step in steps)


def get(document: Any, path: Path, otherwise: Any = MISSING) -> Any:
    """The value at a path; ``otherwise`` if nothing is there."""
    for step in path:
        try:
            document = document[step]
        except (KeyError, IndexError, TypeError):
            return otherwise
    return document


def put(document: Any, path: Path, value: Any) -> None:
    """Sets the value at a path, objects on the way made; MISSING removes it."""
    for step in path[:-1]:
        if isinstance(document, dict) and not isinstance(document.get(step), dict | list):
            document[step] = {}
        document = document[step]
    if value is MISSING:
        if isinstance(document, dict):
            document.pop(path[-1], None)
        else:
            del document[path[-1]]
    else:
        document[path[-1]] = value


def names(design: dict, of: str) -> list[str]:
    """Names in a list under ``cooling``."""
    items = get(design, ("cooling", of), [])
    return [i["name"] for i in items if isinstance(i, dict) and isinstance(i.get("name"), str)]


def example(designs: list[dict], path: Path) -> Any:
    """The first item that any of these designs has in the list at ``path``, whose indices stand for any."""
    for design in designs:
        for found in _all(design, path):
            if isinstance(found, list) and found:
                return deepcopy(found[0])
    return MISSING


def _all(value: Any, path: Path) -> Iterator[Any]:
    if not path:
        yield value
    elif isinstance(path[0], int):
        for item in value if isinstance(value, list) else ():
            yield from _all(item, path[1:])
    elif isinstance(value, dict) and path[0] in value:
        yield from _all(value[path[0]], path[1:])
