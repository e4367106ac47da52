"""GLB, OBJ and STL: closed, outward, of the right size, with regions called like the faces."""

from __future__ import annotations

import numpy as np
import pytest

import cli
import close
import meshes

READERS = {"obj": meshes.read_obj, "stl": meshes.read_stl}


@pytest.fixture(scope="session")
def exported(model) -> dict[tuple[str, str], list[meshes.Region]]:
    """The regions of every part, by part and format."""
    found = {
        (part, kind): read(model.file(part, kind)) for kind, read in READERS.items() for part in model.parts
    }
    for part in model.parts:
        nodes = meshes.read_glb(model.file(part, "glb"))
        found[part, "glb"] = [region for node in nodes for region in node.regions]
    return found


@pytest.fixture(scope="session")
def assembly(model) -> list[meshes.Node]:
    return meshes.read_glb(model.file("assembly", "glb"))


def test_closed(model, exported):
    closed = {what: regions for what, regions in exported.items() if what[1] != "glb"}
    for part in model.parts:  # a GLB node by node: each has its own origin
        closed |= {(n.name, "glb"): n.regions for n in meshes.read_glb(model.file(part, "glb"))}
    for what, regions in closed.items():
        assert meshes.sides_not_paired(regions) == 0, what
        assert meshes.degenerate(regions) == 0, what


def test_genus(model, exported, assembly):
    for what, regions in exported.items():
        if what[1] != "glb":
            assert meshes.genus(regions) == model.genus(what[0]), what
    for node in assembly:
        assert meshes.genus(node.regions) == model.report["genus"][node.name]["expected"], node.name


def test_volume_is_right_and_outward(model, exported):
    for what, regions in exported.items():
        off = abs(meshes.volume(regions) - model.total(what[0], "volume_mm3"))
        assert off <= close.CHORD_MM * model.total(what[0], "area_mm2"), f"{what}: {meshes.volume(regions)}"


def test_area(model, exported):
    for what, regions in exported.items():
        assert close.relative(meshes.area(regions), model.total(what[0], "area_mm2")) < 0.01, what


def test_regions_are_called_like_the_faces(model, exported):
    for what, regions in exported.items():
        names = [region.name for region in regions]
        assert set(names) == model.face_names(what[0]), what
        assert len(names) == len(set(names)), f"{what}: a region in several pieces"


def test_normals_look_outward(exported):
    for what, regions in exported.items():
        assert meshes.normals_turned_away(regions) == 0, what
        if what[1] == "glb":
            assert all(region.normals is not None for region in regions), what


def test_box_in_the_right_unit_and_way_up(model, exported):
    """OBJ and STL in mm as they are; GLB in metres with y up."""
    for what, regions in exported.items():
        close.assert_box(meshes.box(regions), model.box(what[0]), str(what), close.BOX_MM + close.CHORD_MM)


def test_a_node_a_solid(model, assembly):
    assert sorted(node.name for node in assembly) == sorted(model.report["solids"])
    for part in model.parts:
        names = [node.name for node in meshes.read_glb(model.file(part, "glb"))]
        assert sorted(names) == sorted(model.solids(part))


def test_assembly_is_closed_and_placed(model, assembly):
    for node in assembly:
        assert meshes.sides_not_paired(node.regions) == 0, node.name
        faces = {face["name"] for face in model.report["faces"] if node.name in face["solids"]}
        assert {region.name for region in node.regions} == faces, node.name
        box = model.report["solids"][node.name]["bounding_box_mm"]
        limit = close.BOX_MM + close.CHORD_MM
        close.assert_box(meshes.box(node.regions), [box["min"], box["max"]], node.name, limit)


def test_positions_are_stored_near_a_local_origin(model, assembly):
    """Float32 is exact to nanometres there; far from the axis it would not be."""
    for node in assembly:
        size = np.ptp(meshes.box(node.regions), axis=0).max() / 1000
        stored = max(float(np.abs(region.stored).max()) for region in node.regions)
        assert stored <= size, node.name


def test_metal_and_coolant_differ_in_colour(model, assembly):
    colours = {}
    for node in assembly:
        colours.setdefault(cli.part_of(node.name), set()).update(node.colours.values())
    assert len(colours) == 1 or len({frozenset(found) for found in colours.values()}) > 1
