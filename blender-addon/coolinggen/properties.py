"""Blender properties of a design, made from its form: a class of properties a group of fields.

What a field becomes:

=========  ===========================================================================================
number     a float or an integer with the field's limits; where words may stand for it, an enum ``KEY_word``
law        a float, a switch ``KEY_varies`` and rows ``KEY_rows`` of span fraction and value
tuple      a vector
choice     an enum
group      a pointer
variants   an enum ``KEY_kind`` and a pointer ``KEY_WORD`` for each kind
list       a collection and the number of the chosen item, ``KEY_index``
the rest   JSON text
=========  ===========================================================================================

A field that may be absent and whose absence is no value has a switch ``KEY_given``.
"""

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    IntVectorProperty,
    PointerProperty,
    StringProperty,
)

from .client import forms
from .live import changed

#: Blender's vectors have at most so many numbers.
LONGEST_VECTOR = 32


class LawRow(bpy.types.PropertyGroup):
    """A control point of a law over the span."""

    v: FloatProperty(name="Span fraction", min=0.0, max=1.0, precision=4, update=changed)
    value: FloatProperty(name="Value", precision=4, update=changed)


class TextItem(bpy.types.PropertyGroup):
    """A text of a list."""

    value: StringProperty(name="", update=changed)


def classes(form: forms.Group) -> list[type]:
    """Property groups for a form and all it holds, in the order in which they must be registered; the last is
    the form's own."""
    made: list[type] = [LawRow, TextItem]
    _class(form, "Design", made)
    return made


def word(text: str) -> str:
    """A word of the design as part of a property's name."""
    return text.replace("-", "_")


def switched(field: forms.Field) -> bool:
    """Whether a field has the switch ``KEY_given``."""
    return not field.required and field.default is None and not isinstance(field.shape, forms.List)


def _class(group: forms.Group, name: str, made: list[type]) -> type:
    annotations: dict[str, object] = {}
    for field in group.fields:
        if switched(field):
            annotations[f"{field.key}_given"] = BoolProperty(
                name=field.title, description=f"Whether it is given. {field.description}", update=changed
            )
        annotations.update(_properties(field, f"{name}_{field.key}", made))
    kind = type(f"COOLINGGEN_PG_{name}"[:60], (bpy.types.PropertyGroup,), {"__annotations__": annotations})
    made.append(kind)
    return kind


def _properties(field: forms.Field, name: str, made: list[type]) -> dict[str, object]:
    key = field.key
    about = {"name": field.title, "description": _about(field)}
    told = {**about, "update": changed}
    match field.shape:
        case forms.Number() as number:
            return _number(field, number, told)
        case forms.Law() as law:
            constant = forms.blank(law, field.default if isinstance(field.default, int | float) else None)
            return {
                key: FloatProperty(**told, **_limits(law), default=constant, precision=4),
                f"{key}_varies": BoolProperty(
                    name="Varies over the span", description=about["description"], update=changed
                ),
                f"{key}_rows": CollectionProperty(type=LawRow),
            }
        case forms.Tuple(length=length) as numbers if length <= LONGEST_VECTOR:
            start = forms.blank(numbers, field.default)
            if numbers.integer:
                return {key: IntVectorProperty(**told, **_limits(numbers, int), size=length, default=start)}
            return {
                key: FloatVectorProperty(**told, **_limits(numbers), size=length, default=start, precision=4)
            }
        case forms.Choice(options=options):
            return {key: _enum(told, options, field.default)}
        case forms.Flag():
            return {key: BoolProperty(**told, default=bool(field.default))}
        case forms.Text():
            return {key: StringProperty(**told, default=field.default or "")}
        case forms.Group() as group:
            return {key: PointerProperty(type=_class(group, name, made), **about)}
        case forms.Variants(tag=tag, options=options):
            start = field.default[tag] if field.default else None
            kinds = _enum(told, tuple((kind, meaning) for kind, meaning, _ in options), start)
            pointers = {
                f"{key}_{word(kind)}": PointerProperty(
                    type=_class(group, f"{name}_{word(kind)}", made), **about
                )
                for kind, _, group in options
            }
            return {f"{key}_kind": kinds, **pointers}
        case forms.List(item=forms.Group() as item):
            return {
                key: CollectionProperty(type=_class(item, name, made), **about),
                f"{key}_index": IntProperty(),
            }
        case forms.List(item=forms.Text()):
            return {key: CollectionProperty(type=TextItem, **about), f"{key}_index": IntProperty()}
    return {key: StringProperty(**told, default="null")}


def _number(field: forms.Field, number: forms.Number, told: dict) -> dict[str, object]:
    start = field.default if isinstance(field.default, int | float) else None
    plain = forms.Number(number.minimum, number.maximum, number.integer)
    start = forms.blank(plain, start)
    if number.integer:
        made = {field.key: IntProperty(**told, **_limits(number, int), default=int(start))}
    else:
        made = {field.key: FloatProperty(**told, **_limits(number), default=start, precision=4)}
    if number.words:
        options = (("number", "A number."), *((each, "") for each in number.words))
        chosen = field.default if field.default in number.words else "number"
        made[f"{field.key}_word"] = _enum(told, options, chosen)
    return made


def _limits(shape, kind: type = float) -> dict:
    limits = {}
    if shape.minimum is not None:
        limits["min"] = kind(shape.minimum)
    if shape.maximum is not None:
        limits["max"] = kind(shape.maximum)
    return limits


def _enum(told: dict, options, default: str | None) -> object:
    items = [(each, forms.title(each.replace("-", "_")), meaning) for each, meaning in options]
    return EnumProperty(**told, items=items, default=default or items[0][0])


def _about(field: forms.Field) -> str:
    # Blender puts the full stop.
    return field.description.removesuffix(".")
