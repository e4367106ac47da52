"""The form of a design: what an editor shows, made from the JSON Schema that the sidecar gives.

``form(schema)`` is a tree of fields. A field says its key in the design, its title, its unit, and a shape: a
number, a law over the span, a choice, a group of fields, a list and so on. An editor has one widget a shape
and knows nothing of blades. Lengths are mm, angles degrees.
"""

import json
import re
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Number:
    """A number within limits, where there are any."""

    minimum: float | None = None
    maximum: float | None = None
    integer: bool = False
    words: tuple[str, ...] = ()
    """What may stand instead of the number, such as ``auto``."""


@dataclass(frozen=True)
class Law:
    """A number, or control points ``[[v, value], ...]`` over the span fraction v."""

    minimum: float | None = None
    maximum: float | None = None


@dataclass(frozen=True)
class Tuple:
    """So many numbers."""

    length: int
    minimum: float | None = None
    maximum: float | None = None
    integer: bool = False


@dataclass(frozen=True)
class Table:
    """Rows of so many numbers: points."""

    columns: int


@dataclass(frozen=True)
class Choice:
    """One of some words, each with its meaning."""

    options: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Flag:
    """Yes or no."""


@dataclass(frozen=True)
class Text:
    """Text, matching a regular expression where there is one."""

    pattern: str | None = None


@dataclass(frozen=True)
class Raw:
    """JSON that has no widget of its own, such as knots and control nets."""


@dataclass(frozen=True)
class Group:
    """An object of fields."""

    fields: tuple["Field", ...]


@dataclass(frozen=True)
class Variants:
    """An object of one kind out of some: the field ``tag`` says which, and with it the other fields."""

    tag: str
    options: tuple[tuple[str, str, Group], ...]
    """Word, meaning, fields without the tag."""


@dataclass(frozen=True)
class List:
    """A list of things of one shape."""

    item: "Shape"
    maximum: int | None = None


Shape = Number | Law | Tuple | Table | Choice | Flag | Text | Raw | Group | Variants | List


@dataclass(frozen=True)
class Field:
    """A field of an object."""

    key: str
    title: str
    description: str
    shape: Shape
    unit: str = ""
    """``mm``, ``deg``, or words."""
    required: bool = True
    """Whether the object must have it."""
    default: object = field(default=None, hash=False)
    """What its absence means, ``None`` for nothing."""


def form(schema: dict) -> Group:
    """The form of a design."""
    shape = _shape(schema, schema["$defs"])
    assert isinstance(shape, Group)
    return shape


def title(key: str) -> str:
    """How people read a key: ``inclination_deg`` is an inclination, ``width_d`` a width by diameter."""
    words = key.removesuffix("_deg").replace("_", " ")
    words = re.sub(r" d$", " / D", words)
    return words[:1].upper() + words[1:]


def blank(shape: Shape, default: object = None) -> object:
    """What an editor begins with where it adds a thing of this shape."""
    if default is not None:
        return json.loads(json.dumps(default))
    match shape:
        case Number(words=words) if words:
            return words[0]
        case Number() | Law():
            return _within(shape, 1)
        case Tuple():
            low, high = shape.minimum, shape.maximum
            if shape.length == 2 and low is not None and high is not None:
                return [low, high]
            return [_within(shape, 0)] * shape.length
        case Table() | List() | Raw():
            return []
        case Choice(options=options):
            return options[0][0]
        case Flag():
            return False
        case Text():
            return ""
        case Group(fields=fields):
            return {one.key: blank(one.shape, one.default) for one in fields if one.required}
        case Variants(tag=tag, options=options):
            word, _, group = options[0]
            return {tag: word, **blank(group)}


def _within(shape: Number | Law | Tuple, value: float) -> float:
    if shape.minimum is not None:
        value = max(value, shape.minimum)
    return value if shape.maximum is None else min(value, shape.maximum)


def _fields(node: dict, defs: dict, without: str = "") -> tuple[Field, ...]:
    required = node.get("required", [])
    return tuple(
        _field(key, part, defs, key in required)
        for key, part in node.get("properties", {}).items()
        if key != without
    )


def _field(key: str, node: dict, defs: dict, required: bool) -> Field:
    whole = _resolved(_without_null(node), defs)
    return Field(
        key=key,
        title=node.get("title", title(key)),
        description=_one_line(node.get("description", whole.get("description", ""))),
        shape=_shape(_without_null(node), defs),
        unit=node.get("unit", ""),
        required=required,
        default=node.get("default"),
    )


def _without_null(node: dict) -> dict:
    """The node, where null is one of the things it may be: without it. Absence says the same."""
    if isinstance(node.get("type"), list):
        kinds = [kind for kind in node["type"] if kind != "null"]
        return {**node, "type": kinds[0] if len(kinds) == 1 else kinds}
    parts = node.get("anyOf", [])
    left = [part for part in parts if part.get("type") != "null"]
    if len(left) == 1 and len(parts) == 2:
        return {**left[0], **{key: value for key, value in node.items() if key != "anyOf"}}
    return node


def _resolved(node: dict, defs: dict) -> dict:
    """The node with what it refers to put in; its own words win."""
    while "$ref" in node:
        target = defs[node["$ref"].removeprefix("#/$defs/")]
        node = {**target, **{key: value for key, value in node.items() if key != "$ref"}}
    return node


def _shape(node: dict, defs: dict) -> Shape:
    node = _resolved(node, defs)
    limits = {"minimum": node.get("minimum"), "maximum": node.get("maximum")}
    if node.get("law"):
        return Law(**limits)
    if "oneOf" in node:
        return _choice(node["oneOf"], defs)
    if "anyOf" in node:
        return _number_or_word(node["anyOf"], limits, defs)
    match node.get("type"):
        case "number":
            return Number(**limits)
        case "integer":
            return Number(**limits, integer=True)
        case "string":
            return Text(node.get("pattern"))
        case "boolean":
            return Flag()
        case "object":
            return Group(_fields(node, defs))
        case "array":
            return _array(node, defs)
    return Raw()


def _array(node: dict, defs: dict) -> Shape:
    item = _resolved(node["items"], defs)
    length = node.get("minItems")
    if item.get("type") in ("number", "integer") and length is not None and length == node.get("maxItems"):
        return Tuple(length, item.get("minimum"), item.get("maximum"), item["type"] == "integer")
    if item.get("type") == "array":
        columns = item.get("minItems")
        if item["items"].get("type") == "number" and columns is not None and columns == item.get("maxItems"):
            return Table(columns)
        return Raw()
    shape = _shape(item, defs)
    return List(shape, node.get("maxItems")) if isinstance(shape, Group | Variants | Text) else Raw()


def _choice(parts: list[dict], defs: dict) -> Shape:
    parts = [_resolved(part, defs) for part in parts]
    if all(part.get("type") == "string" and "const" in part for part in parts):
        return Choice(tuple((part["const"], _one_line(part.get("description", ""))) for part in parts))
    tags = [key for key, part in parts[0].get("properties", {}).items() if "const" in part]
    if len(tags) != 1 or not all("const" in part.get("properties", {}).get(tags[0], {}) for part in parts):
        return Raw()
    tag = tags[0]
    return Variants(
        tag,
        tuple(
            (
                part["properties"][tag]["const"],
                _one_line(part.get("description", "")),
                Group(_fields(part, defs, tag)),
            )
            for part in parts
        ),
    )


def _number_or_word(parts: list[dict], limits: dict, defs: dict) -> Shape:
    shapes = [_shape(part, defs) for part in parts]
    numbers = [shape for shape in shapes if isinstance(shape, Number)]
    words = [option for shape in shapes if isinstance(shape, Choice) for option, _ in shape.options]
    if len(numbers) == 1 and words and len(shapes) == 2:
        return Number(**limits, integer=numbers[0].integer, words=tuple(words))
    # Points to pass through, or a whole spline.
    tables = [shape for shape in shapes if isinstance(shape, Table)]
    return tables[0] if len(tables) == 1 else Raw()


def _one_line(text: str) -> str:
    return " ".join(text.split())
