"""Bores meet their faces in their edges and nowhere else, as OpenCASCADE sees it.

FreeCAD's BOP check says so of whole samples, in `tests/run --long` alone.
"""

from __future__ import annotations

import pytest

import cli
import crossings

# What the check takes for the same place is 1e-6 mm: ten times its tolerance of an edge.
SAME = 1e-6

# Rows over borders of both the leading chamber and the blade, with bores that these part into slivers.
ROWS = [("rotor-serpentine", "film/head_suction/")]


@pytest.mark.parametrize(("of", "row"), ROWS)
def test_bores_cross_their_neighbours_in_shared_edges(library, of, row):
    model = library.model(cli.SAMPLES / f"{of}.json")
    (coolant,) = library.products(model.file("coolant", "step"))
    pairs = list(crossings.neighbours(coolant, row))
    assert len(pairs) > 100
    away = {(a.name, b.name): crossings.beside_edges(a, b) for a, b in pairs}
    assert {names: mm for names, mm in away.items() if mm > SAME} == {}
