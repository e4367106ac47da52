"""Designs into Blender properties and back.

Blender's floats have 32 bits: a number that still is what a design's number became is that number.
"""

import json
import struct

from .client import forms
from .properties import switched, word


def write(owner, group: forms.Group, design: dict) -> None:
    """Sets the properties of ``owner`` as ``design`` says."""
    for field in group.fields:
        given = field.key in design
        if switched(field):
            setattr(owner, f"{field.key}_given", given)
        if given or field.default is not None:
            _write(owner, field.key, field.shape, design.get(field.key, field.default))
        elif isinstance(field.shape, forms.List):
            getattr(owner, field.key).clear()


def read(owner, group: forms.Group, last: dict) -> dict:
    """The design that the properties of ``owner`` say; ``last`` is the one that they were set from."""
    design = {}
    for field in group.fields:
        if switched(field) and not getattr(owner, f"{field.key}_given"):
            continue
        before = last.get(field.key)
        value = _read(owner, field.key, field.shape, field.default if before is None else before)
        unsaid = field.default if field.default is not None else []
        if field.required or field.key in last or value != unsaid:
            design[field.key] = value
    # In the order of the design that they were set from, then of the form.
    return {
        key: design[key] for key in [*(k for k in last if k in design), *(k for k in design if k not in last)]
    }


def _write(owner, key: str, shape: forms.Shape, value) -> None:
    match shape:
        case forms.Number(words=words):
            if words:
                setattr(owner, f"{key}_word", value if value in words else "number")
            if value not in words:
                setattr(owner, key, value)
        case forms.Law():
            varies = isinstance(value, list)
            setattr(owner, f"{key}_varies", varies)
            rows = getattr(owner, f"{key}_rows")
            rows.clear()
            if not varies:
                setattr(owner, key, value)
                return
            for v, number in value:
                row = rows.add()
                row.v, row.value = v, number
        case forms.Group() as group:
            write(getattr(owner, key), group, value)
        case forms.Variants(tag=tag, options=options):
            setattr(owner, f"{key}_kind", value[tag])
            group = next(group for kind, _, group in options if kind == value[tag])
            write(getattr(owner, f"{key}_{word(value[tag])}"), group, value)
        case forms.List(item=item):
            things = getattr(owner, key)
            things.clear()
            for each in value:
                if isinstance(item, forms.Text):
                    things.add().value = each
                else:
                    write(things.add(), item, each)
        case forms.Choice() | forms.Flag() | forms.Text() | forms.Tuple():
            setattr(owner, key, value)
        case _:
            setattr(owner, key, json.dumps(value))


def _read(owner, key: str, shape: forms.Shape, last):
    match shape:
        case forms.Number(words=words, integer=integer):
            if words and getattr(owner, f"{key}_word") != "number":
                return getattr(owner, f"{key}_word")
            return getattr(owner, key) if integer else _float(getattr(owner, key), last)
        case forms.Law():
            if not getattr(owner, f"{key}_varies"):
                return _float(getattr(owner, key), last)
            before = last if isinstance(last, list) else []
            rows = getattr(owner, f"{key}_rows")
            return [
                [_float(row.v, old[0] if old else None), _float(row.value, old[1] if old else None)]
                for row, old in zip(rows, [*before, *[None] * len(rows)], strict=False)
            ]
        case forms.Tuple(length=length, integer=integer):
            numbers = list(getattr(owner, key))
            if integer:
                return numbers
            before = last if isinstance(last, list) and len(last) == length else [None] * length
            return [_float(number, old) for number, old in zip(numbers, before, strict=True)]
        case forms.Group() as group:
            return read(getattr(owner, key), group, last if isinstance(last, dict) else {})
        case forms.Variants(tag=tag, options=options):
            kind = getattr(owner, f"{key}_kind")
            group = next(group for each, _, group in options if each == kind)
            before = last if isinstance(last, dict) and last.get(tag) == kind else {}
            return {tag: kind, **read(getattr(owner, f"{key}_{word(kind)}"), group, before)}
        case forms.List(item=item):
            return _read_list(getattr(owner, key), item, last if isinstance(last, list) else [])
        case forms.Choice() | forms.Flag() | forms.Text():
            return getattr(owner, key)
    try:
        return json.loads(getattr(owner, key))
    except ValueError:
        # The sidecar says that it is none of what it should be.
        return getattr(owner, key)


def _read_list(things, item: forms.Shape, last: list) -> list:
    if isinstance(item, forms.Text):
        return [each.value for each in things]
    named = {old["name"]: old for old in last if isinstance(old, dict) and "name" in old}
    return [
        read(
            each, item, named.get(getattr(each, "name", None), last[k] if k < len(last) and not named else {})
        )
        for k, each in enumerate(things)
    ]


def _float(value: float, last) -> float:
    """A property's number: the last design's if it is still that, else the shortest with the same 32 bits."""
    if isinstance(last, int | float) and _single(last) == value:
        return last
    return next(short for digits in range(1, 10) if _single(short := float(f"{value:.{digits}g}")) == value)


def _single(value: float) -> float:
    return struct.unpack("f", struct.pack("f", value))[0]
