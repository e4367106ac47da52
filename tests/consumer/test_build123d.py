"""build123d's own import: labels, colours, millimetres, volume."""

from __future__ import annotations

import numpy as np
import pytest
from build123d import Shape, import_step

import close


@pytest.fixture(scope="session")
def imported(model) -> dict[str, list[Shape]]:
    return {part: leaves(import_step(model.file(part, "step"))) for part in (*model.parts, "assembly")}


def leaves(shape: Shape) -> list[Shape]:
    return [leaf for child in shape.children for leaf in leaves(child)] if shape.children else [shape]


def labelled(name: str) -> str:
    """build123d puts underscores for blanks, dots and brackets."""
    return name.translate(str.maketrans(" .()", "____"))


def test_labels(model, imported):
    for part in model.parts:
        assert sorted(s.label for s in imported[part]) == sorted(map(labelled, model.solids(part)))
    assert sorted(s.label for s in imported["assembly"]) == sorted(map(labelled, model.report["solids"]))


def test_colours(imported):
    for part, shapes in imported.items():
        for shape in shapes:
            assert shape.color is not None, f"{part}: {shape.label}"


def test_volume(model, imported):
    for part in model.parts:
        close.assert_volume(sum(s.volume for s in imported[part]), model.total(part, "volume_mm3"), part)


def test_millimetres(model, imported):
    for part in model.parts:
        boxes = [shape.bounding_box(optimal=True) for shape in imported[part]]
        low = np.min([tuple(box.min) for box in boxes], axis=0)
        high = np.max([tuple(box.max) for box in boxes], axis=0)
        close.assert_held([low, high], model.box(part), part)
