"""The add-ons' form of a design shows all that a design may have."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

import cli

sys.path.insert(0, str(cli.REPOSITORY / "freecad-addon" / "freecad" / "coolinggen"))

from client import forms
from client.formats import FORMATS

#: What has no widget: points by their number or place, nets and knots.
RAW = {"leading_edge", "trailing_edge", "knots_u", "knots_v", "points", "weights"}


@pytest.fixture(scope="session")
def form() -> forms.Group:
    return forms.form(json.loads(cli.run("schema").stdout))


def test_hardly_anything_is_raw(form):
    found = {field.key for field in _all_fields(form) if isinstance(field.shape, forms.Raw)}
    assert found == RAW


def test_numbers_of_the_cooling_have_a_title_a_description_and_limits(form):
    cooling = next(field for field in form.fields if field.key == "cooling")
    numbers = [f for f in _all_fields(cooling.shape) if isinstance(f.shape, forms.Number | forms.Law)]
    assert len(numbers) > 50
    for field in numbers:
        assert field.title[0].isupper() and field.description.endswith("."), field.key
        assert field.shape.minimum is not None and field.shape.maximum is not None, field.key


def test_samples_fit_the_form(form, sample):
    _fits(form, json.loads(sample.read_text(encoding="utf-8")), "")


def test_what_an_editor_begins_with_fits_the_form(form):
    for field in _all_fields(form):
        _fits(field.shape, forms.blank(field.shape, field.default), field.key)


def test_export_dialogs_offer_every_format():
    asked = {"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {"protocol_version": 1}}
    done = subprocess.run(
        [cli.BINARY, "serve"],
        input=json.dumps(asked) + "\n",
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    assert list(FORMATS) == json.loads(done.stdout.splitlines()[0])["result"]["formats"]


def test_titles():
    assert forms.title("inclination_deg") == "Inclination"
    assert forms.title("metering_length_d") == "Metering length / D"


def _all_fields(shape):
    match shape:
        case forms.Group(fields=fields):
            for field in fields:
                yield field
                yield from _all_fields(field.shape)
        case forms.Variants(options=options):
            for _, _, group in options:
                yield from _all_fields(group)
        case forms.List(item=item):
            yield from _all_fields(item)


def _number(value) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _fits(shape, value, at: str) -> None:
    match shape:
        case forms.Number(minimum=low, maximum=high, words=words):
            assert value in words or (_number(value) and _between(low, value, high)), at
        case forms.Law(minimum=low, maximum=high):
            values = [value] if _number(value) else [row[1] for row in value]
            assert all(_number(one) and _between(low, one, high) for one in values), at
        case forms.Tuple(length=length):
            assert len(value) == length and all(map(_number, value)), at
        case forms.Table(columns=columns):
            # Or a whole spline.
            assert isinstance(value, dict) or all(len(row) == columns for row in value), at
        case forms.Choice(options=options):
            assert value in {word for word, _ in options}, at
        case forms.Flag():
            assert isinstance(value, bool), at
        case forms.Text():
            assert isinstance(value, str), at
        case forms.Group(fields=fields):
            _object_fits(fields, value, at)
        case forms.Variants(tag=tag, options=options):
            (group,) = [group for word, _, group in options if word == value[tag]]
            _object_fits(group.fields, {key: part for key, part in value.items() if key != tag}, at)
        case forms.List(item=item):
            for k, part in enumerate(value):
                _fits(item, part, f"{at}/{k}")


def _object_fits(fields, value: dict, at: str) -> None:
    known = {field.key: field for field in fields}
    assert set(value) <= set(known), f"{at}: {set(value) - set(known)}"
    assert {key for key, field in known.items() if field.required} <= set(value), at
    for key, part in value.items():
        _fits(known[key].shape, part, f"{at}/{key}")


def _between(low, value, high) -> bool:
    return (low is None or value >= low) and (high is None or value <= high)
