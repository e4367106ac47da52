"""What a form of a design looks like, from its JSON Schema: one node a field, with title, unit, limits and help.

A program's panel makes a widget of each node and need not know a single field by name.
"""

import re
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass, field, replace
from typing import Any

#: Stands for "no default".
MISSING: Any = object()

#: Fields that hold the name of something else in the design, and the list under ``cooling`` where these are.
REFERENCES = {"chamber": "chambers", "between": "chambers", "wall": "walls"}

#: Fields that a form has no business with.
SILENT = ("format",)


@dataclass(frozen=True)
class Node:
    """A field: what may stand there.

    ``kind`` is one of
    ``object`` (of ``fields``), ``list`` (of ``item``), ``variants`` (objects that ``tag`` tells apart),
    ``either`` (of ``options``, which differ in type), ``law`` (a number or control points ``[v, value]``),
    ``row`` (a fixed number of numbers), ``words`` (a fixed number of names), ``table`` (any number of rows),
    ``number``, ``integer``, ``text``, ``choice`` (of ``words``), ``boolean``, ``raw`` (anything else, as JSON).
    """

    name: str
    kind: str
    help: str = ""
    group: str = ""
    unit: str = ""
    minimum: float | None = None
    maximum: float | None = None
    default: Any = MISSING
    required: bool = True
    nullable: bool = False
    pattern: str = ""
    tag: str = ""
    columns: int = 0
    most: int | None = None
    item: "Node | None" = None
    words: dict[str, str] = field(default_factory=dict)
    fields: tuple["Node", ...] = ()
    options: tuple["Node", ...] = ()

    @property
    def title(self) -> str:
        """The field's name in plain words."""
        return title(self.name)

    @property
    def small(self) -> bool:
        """Whether it fits on a line of a form."""
        return self.kind not in ("object", "list", "variants", "table", "raw", "either") or (
            self.kind == "either" and all(option.small for option in self.options)
        )


def title(name: str) -> str:
    """A field's name in plain words: its unit's suffix is shown by its value."""
    words = re.sub(r"_(deg|mm|d)$", "", name).replace("_", " ").replace("-", " ")
    return words[:1].upper() + words[1:]


def describe(schema: dict) -> Node:
    """The form of a schema."""
    return _node("", schema, schema.get("$defs", {}), required=True)


def _node(name: str, schema: dict, defs: dict, *, required: bool) -> Node:
    nullable = False
    while True:
        if "$ref" in schema:
            # What stands beside the reference speaks of this field and wins.
            named = defs[schema["$ref"].removeprefix("#/$defs/")]
            schema = {**named, **{k: v for k, v in schema.items() if k != "$ref"}}
        elif {"type": "null"} in schema.get("anyOf", []):
            rest = [s for s in schema["anyOf"] if s != {"type": "null"}]
            outside = {k: v for k, v in schema.items() if k != "anyOf"}
            schema = {**rest[0], **outside} if len(rest) == 1 else {**outside, "anyOf": rest}
            nullable = True
        elif isinstance(schema.get("type"), list):
            nullable = "null" in schema["type"]
            rest = [kind for kind in schema["type"] if kind != "null"]
            schema = {**schema, "type": rest[0]}
        else:
            break
    made = Node(
        name=name,
        kind="raw",
        help=" ".join(schema.get("description", "").split()),
        group=schema.get("group", ""),
        unit=schema.get("unit", _unit(name, schema)),
        minimum=schema.get("minimum"),
        maximum=schema.get("maximum"),
        default=schema.get("default", MISSING),
        required=required,
        nullable=nullable,
        pattern=schema.get("pattern", ""),
    )
    return _of_kind(made, schema, defs)


def _of_kind(made: Node, schema: dict, defs: dict) -> Node:
    options = schema.get("oneOf") or schema.get("anyOf") or []
    if schema.get("law"):
        return replace(made, kind="law", columns=2)
    if options and all("const" in option for option in options):
        words = {option["const"]: option.get("description", "") for option in options}
        return replace(made, kind="choice", words=words)
    if "enum" in schema:
        return replace(made, kind="choice", words=dict.fromkeys(schema["enum"], ""))
    if options and (tag := _tag(options, defs)):
        variants = tuple(_variant(option, tag, defs) for option in options)
        return replace(made, kind="variants", tag=tag, options=variants)
    if options:
        # Limits and unit stand beside the alternatives.
        beside = {k: schema[k] for k in ("minimum", "maximum", "unit") if k in schema}
        each = tuple(_node(made.name, {**beside, **o}, defs, required=True) for o in options)
        return replace(made, kind="either", options=each)
    kind = schema.get("type")
    if kind == "object":
        return replace(made, kind="object", fields=_fields(schema, defs))
    if kind == "array":
        return _array(made, schema, defs)
    if kind in ("number", "integer", "boolean"):
        return replace(made, kind=kind)
    if kind == "string":
        return replace(made, kind="text")
    return made


def _fields(schema: dict, defs: dict, without: str = "") -> tuple[Node, ...]:
    required = schema.get("required", ())
    return tuple(
        _node(name, field, defs, required=name in required)
        for name, field in schema.get("properties", {}).items()
        if name != without and name not in SILENT
    )


def _array(made: Node, schema: dict, defs: dict) -> Node:
    item = _node(made.name, schema.get("items", {}), defs, required=True)
    size = schema.get("minItems")
    fixed = size is not None and size == schema.get("maxItems")
    limits = {"minimum": item.minimum, "maximum": item.maximum}
    if fixed and item.kind in ("number", "integer"):
        return replace(made, kind="row", columns=size, item=item, **limits)
    if fixed and item.kind == "text":
        return replace(made, kind="words", columns=size)
    if item.kind == "row":
        return replace(made, kind="table", columns=item.columns, item=item)
    if item.kind in ("object", "variants"):
        return replace(made, kind="list", item=item, most=schema.get("maxItems"))
    return made


def _tag(options: list[dict], defs: dict) -> str:
    """The property whose constant tells the objects apart; empty if there is none."""
    for name in ("kind", "frame"):
        if all("const" in _resolved(o, defs).get("properties", {}).get(name, {}) for o in options):
            return name
    return ""


def _variant(option: dict, tag: str, defs: dict) -> Node:
    schema = _resolved(option, defs)
    name = schema["properties"][tag]["const"]
    told = " ".join(schema.get("description", "").split())
    return Node(name=name, kind="object", help=told, fields=_fields(schema, defs, without=tag))


def _resolved(schema: dict, defs: dict) -> dict:
    return defs[schema["$ref"].removeprefix("#/$defs/")] if "$ref" in schema else schema


def _unit(name: str, schema: dict) -> str:
    """The unit of a field that does not say it: angles end in ``_deg``, lengths tell of mm."""
    if name.endswith("_deg"):
        return "deg"
    return "mm" if re.search(r"\bmm\b", schema.get("description", "")) else ""


def fits(node: Node, value: object) -> bool:
    """Whether a value is of the node's type, limits aside."""
    number = isinstance(value, int | float) and not isinstance(value, bool)
    listed = isinstance(value, list)
    tests = {
        "number": number,
        "integer": number and float(value).is_integer() if number else False,
        "boolean": isinstance(value, bool),
        "text": isinstance(value, str),
        "choice": isinstance(value, str) and value in node.words,
        "object": isinstance(value, dict),
        "variants": isinstance(value, dict),
        "law": number or listed,
        "row": listed and all(isinstance(x, int | float) for x in value),
        "table": listed and all(isinstance(x, list) for x in value),
        "list": listed and all(isinstance(x, dict) for x in value),
        "words": listed and all(isinstance(x, str) for x in value),
        "either": any(fits(option, value) for option in node.options),
    }
    return tests.get(node.kind, True)


def variant(node: Node, value: object) -> int:
    """Which of a node's ``options`` a value is."""
    if node.kind == "variants":
        kind = value.get(node.tag) if isinstance(value, dict) else None
        return next((k for k, option in enumerate(node.options) if option.name == kind), 0)
    return next((k for k, option in enumerate(node.options) if fits(option, value)), 0)


def blank(node: Node, names: tuple[str, ...] = ()) -> Any:
    """A value to start from; ``names`` are taken already."""
    if node.default is not MISSING and node.default is not None:
        return deepcopy(node.default)
    if node.kind == "object":
        return {f.name: blank(f, names) for f in node.fields if f.required}
    if node.kind == "variants":
        first = node.options[0]
        return {node.tag: first.name, **blank(first, names)}
    if node.kind == "either":
        return blank(node.options[0], names)
    if node.kind == "text":
        return unused(names, node.name) if node.name == "name" else ""
    if node.kind == "choice":
        return next(iter(node.words))
    if node.kind in ("number", "law"):
        return _usual(node)
    if node.kind == "integer":
        return int(max(node.minimum or 0, 1))
    if node.kind == "row":
        low, high = node.minimum or 0.0, 1.0 if node.maximum is None else node.maximum
        return [low + (high - low) * (k + 0.1) / (node.columns - 0.8) for k in range(node.columns)]
    return {"boolean": False, "words": [""] * node.columns, "list": [], "table": []}.get(node.kind)


def _usual(node: Node) -> float:
    usual = {"mm": 1.0, "deg": 30.0, "diameters": 3.0}.get(node.unit, 0.5)
    low = usual if node.minimum is None else node.minimum
    high = usual if node.maximum is None else node.maximum
    return min(max(usual, low), high)


def unused(names: tuple[str, ...], wanted: str) -> str:
    """``wanted``, or with a number that makes it new."""
    if wanted not in names:
        return wanted
    stem = re.sub(r"_?\d+$", "", wanted) or wanted
    return next(made for k in range(2, len(names) + 3) if (made := f"{stem}_{k}") not in names)


Path = tuple  #: Names and indices that lead to a value of a document.


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
    """The first item of the list at ``path`` that any of these designs has; indices in the path stand for any."""
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
