"""Samples with a change, seen by OpenCASCADE, FreeCAD and Gmsh, and as meshes."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

import cli
import close
import edits
import measure
import meshes
import topology
import witness

SLOTS = {"name": "te", "span": [0.05, 0.9], "count": 3, "height": 2, "width": 0.4, "corner_radius": 0.1}


def cutback(design: dict) -> dict:
    """Slots open on the pressure side, from a lip to the trailing edge."""
    rows = [SLOTS | {"cutback": {"lip_thickness": 0.45}}]
    return edits.edited(design, {"/name": "cutback", "/cooling/slot_rows": rows})


def four_hundred(design: dict) -> dict:
    """The serpentine's rows with smaller holes, nearer to each other, and three rows more."""
    changes: dict[str, Any] = {"/name": "four-hundred"}
    rows = "/cooling/film_rows"
    for number, row in enumerate(design["cooling"]["film_rows"]):
        changes |= {f"{rows}/{number}/count": 50, f"{rows}/{number}/hole/diameter": 0.25}
        if "shape" in row["hole"]:
            changes[f"{rows}/{number}/hole/shape/metering_length_d"] = 6.5
    design = edits.edited(design, changes)
    for position in (0.5, 0.58, 0.66):
        row = {"name": f"at{100 * position:.0f}", "side": "pressure_side", "surface_position": position}
        hole = {"diameter": 0.25, "inclination_deg": 35}
        design["cooling"]["film_rows"].append(row | {"span": [0.15, 0.88], "count": 50, "hole": hole})
    return design


@dataclass(frozen=True)
class Edited:
    sample: str
    edit: Any
    genus: dict[str, int]  # what the design implies, counted by hand


# Open at the hub and closed elsewhere, or with holes of its own: each bore is a handle of the metal.
DESIGNS = {
    "cutback": Edited("rotor", cutback, {"metal": 3}),
    "four-hundred": Edited("rotor-serpentine", four_hundred, {"metal": 412, "coolant/leading": 0}),
}


@pytest.fixture(scope="session", params=DESIGNS)
def asked(request) -> Edited:
    return DESIGNS[request.param]


@pytest.fixture(scope="session")
def built(library, asked, tmp_path_factory) -> cli.Model:
    source = json.loads((cli.SAMPLES / f"{asked.sample}.json").read_text(encoding="utf-8"))
    design = asked.edit(source)
    path = tmp_path_factory.mktemp("edited") / f"{design['name']}.json"
    return library.model(edits.write(path, design))


@pytest.fixture(scope="session")
def products(library, built):
    return [product for part in built.parts for product in library.products(built.file(part, "step"))]


def test_opencascade_finds_valid_closed_solids(products):
    for product in products:
        assert topology.faults(product.shape) == [], product.name
        assert topology.free_edges(product.shape) == 0, product.name
        assert topology.greatest_tolerance(product.shape) <= close.TOLERANCE_MM, product.name


def test_genus_of_solids(asked, built, products):
    for product in products:
        genus = topology.genus(product.shape)
        assert genus == built.report["genus"][product.name]["expected"], product.name
        assert genus == asked.genus.get(product.name, genus), product.name


def steps_in_time(built) -> list[Path]:
    """The files of its parts, unless what is asked of them takes minutes."""
    steps = [built.file(part, "step") for part in built.parts]
    if any(map(witness.too_great, steps)):
        witness.leave_to_long(built.name)
    return steps


def test_volumes(built, products):
    steps_in_time(built)
    for product in products:
        expected = built.report["solids"][product.name]["volume_mm3"]
        for rule in (measure.volume_fixed, measure.volume_adaptive, measure.volume_mesh):
            close.assert_volume(rule(product.shape), expected, f"{product.name} by {rule.__name__}")


def test_meshes_are_closed_and_have_the_genus(asked, built):
    for node in meshes.read_glb(built.file("assembly", "glb")):
        assert meshes.sides_not_paired(node.regions) == meshes.degenerate(node.regions) == 0, node.name
        assert meshes.normals_turned_away(node.regions) == 0, node.name
        genus = meshes.genus(node.regions)
        assert genus == asked.genus.get(node.name, built.report["genus"][node.name]["expected"]), node.name
    for part in built.parts:
        for kind, read in {"obj": meshes.read_obj, "stl": meshes.read_stl}.items():
            regions = read(built.file(part, kind))
            assert meshes.sides_not_paired(regions) == meshes.degenerate(regions) == 0, f"{part} {kind}"
            assert meshes.normals_turned_away(regions) == 0, f"{part} {kind}"
            assert meshes.genus(regions) == built.genus(part), f"{part} {kind}"


def test_bop_check_is_clean(built, tmp_path):
    steps = steps_in_time(built)
    found = witness.freecad(steps, tmp_path)
    for step in steps:
        for thing in found.of(step)["objects"]:
            assert thing["valid"] and thing["closed"] and not thing["bop"], (
                f"{thing['label']}: {thing['bop']}"
            )


def test_gmsh_fills_the_solids(built, tmp_path):
    steps = steps_in_time(built)
    found = witness.gmsh(steps, tmp_path)
    for step in steps:
        fill = found.of(step)["fill"]
        assert "error" not in fill, f"{step.name}: {fill['error']}"
        assert fill["tetrahedra"] > 0, step.name
        assert fill["inverted"] == fill["unmatched"] == fill["crowded"] == 0, f"{step.name}: {fill}"
