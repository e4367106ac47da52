"""OpenCASCADE reads every STEP file: valid, closed, tight, named, coloured, and of the reported size."""

from __future__ import annotations

import pytest

import close
import measure
import occ
import topology


@pytest.fixture(scope="session")
def products(library, model) -> dict[str, list[occ.Product]]:
    """The products in the file of each part."""
    return {part: library.products(model.file(part, "step")) for part in model.parts}


@pytest.fixture(scope="session")
def assembly(library, model) -> list[occ.Product]:
    return library.products(model.file("assembly", "step"))


def each(products) -> list[occ.Product]:
    return [product for found in products.values() for product in found]


def test_valid(products):
    for product in each(products):
        assert topology.faults(product.shape) == [], product.name


def test_one_solid_a_product(products, assembly):
    for product in each(products) + assembly:
        assert len(occ.sub_shapes(product.shape, topology.SOLID)) == 1, product.name


def test_a_named_product_a_solid(model, products, assembly):
    for part, found in products.items():
        assert sorted(product.name for product in found) == sorted(model.solids(part))
    assert sorted(product.name for product in assembly) == sorted(model.report["solids"])


def test_no_free_edges(products):
    for product in each(products):
        assert topology.free_edges(product.shape) == 0, product.name


def test_no_loose_tolerances(products):
    for product in each(products):
        assert topology.greatest_tolerance(product.shape) <= close.TOLERANCE_MM, product.name


def test_genus(model, products):
    for product in each(products):
        assert topology.genus(product.shape) == model.report["genus"][product.name]["expected"], product.name


@pytest.mark.parametrize("rule", [measure.volume_fixed, measure.volume_adaptive, measure.volume_mesh])
def test_volume(model, products, rule):
    for product in each(products):
        expected = model.report["solids"][product.name]["volume_mm3"]
        close.assert_volume(rule(product.shape), expected, product.name)


def test_solids_make_up_the_uncooled_blade(model, products):
    total = sum(measure.volume_adaptive(product.shape) for product in each(products))
    close.assert_volume(total, model.report["blank"]["volume_mm3"], "sum of solids")


def test_bounding_box_in_mm(model, products):
    for product in each(products):
        box = model.report["solids"][product.name]["bounding_box_mm"]
        close.assert_held(measure.box(product.shape), [box["min"], box["max"]], product.name)


def test_number_of_faces(model, products):
    for product in each(products):
        assert len(product.faces) == model.report["solids"][product.name]["faces"], product.name


def test_face_names(model, products, assembly):
    for product in each(products) + assembly:
        expected = {face["name"] for face in model.report["faces"] if product.name in face["solids"]}
        assert {face.name for face in product.faces} == expected, product.name


def test_every_face_has_a_colour_and_a_layer(products, assembly):
    for product in each(products) + assembly:
        for face in product.faces:
            assert face.colour is not None, face.name
            assert face.layers, face.name


def test_shared_faces_look_the_same_in_both_solids(assembly):
    colours = {}
    for product in assembly:
        for face in product.faces:
            colours.setdefault(face.name, set()).add(face.colour)
    assert {name for name, found in colours.items() if len(found) > 1} == set()
