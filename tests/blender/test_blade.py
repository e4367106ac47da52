"""Blades in the scene: right meshes, right size, and what is the user's stays."""

from __future__ import annotations

import importlib
import json
from pathlib import Path

import bpy
import numpy as np
import pytest

import measure
from conftest import MODULE, ROOT

SAMPLES = sorted((ROOT / "samples").glob("*.json"))


def blades():
    return importlib.import_module(f"{MODULE}.blades")


def solids(collection):
    return blades().objects(collection)


def report(collection) -> dict:
    return json.loads(collection.coolinggen.report)


def sound(collection, metres: float) -> None:
    """Whether a blade's meshes are what its report says, in a scene whose unit is so many metres."""
    told = report(collection)["solids"]
    assert set(solids(collection)) == set(told)
    for name, found in solids(collection).items():
        assert not found.data.validate(), name
        assert measure.closed(found.data), name
        # Chords lie within the tolerance of the surface.
        chord = collection.coolinggen.chord_mm
        millimetres = 1e3 * metres
        volume = measure.volume(found.data) * millimetres**3
        assert abs(volume - told[name]["volume_mm3"]) < 1.01 * chord * told[name]["area_mm2"], name
        low, high = (np.array(told[name]["bounding_box_mm"][end]) for end in ("min", "max"))
        points = measure.triangles(found.data)[0] * millimetres
        # Single precision keeps seven digits.
        reach = 1.01 * chord + 1e-6 * np.abs([low, high]).max()
        assert np.abs(points.min(axis=0) - low).max() < reach, name
        assert np.abs(points.max(axis=0) - high).max() < reach, name
        given, flat = measure.normals(found.data)
        # The surface's normals, outward: nowhere far from those of the triangles.
        assert (np.einsum("ijk,ijk->ij", given, flat) > 0.5).mean() > 0.999, name


@pytest.mark.parametrize("template", ["rotor", "c3x", "rotor-serpentine", "propeller"])
def test_meshes(template):
    bpy.ops.coolinggen.new(template=template)
    sound(bpy.context.scene.collection.children[-1], 1.0)


def test_normals_survive_what_cycles_does(rotor):
    """It parts a mesh at its sharp edges and then has one normal a point."""
    for name, found in solids(rotor).items():
        parted = found.data.copy()
        before = len(parted.vertices)
        parted.split_faces()
        assert len(parted.vertices) > before, name
        normals = np.empty(3 * len(parted.loops), np.float32)
        parted.corner_normals.foreach_get("vector", normals)
        corners = np.empty(len(parted.loops), np.int32)
        parted.attributes[".corner_vert"].data.foreach_get("value", corners)
        one = np.empty((len(parted.vertices), 3), np.float32)
        one[corners] = normals.reshape(-1, 3)
        alike = np.einsum("ij,ij->i", one[corners], normals.reshape(-1, 3))
        # Edges that fade out, as fillets do, leave a few points with two.
        assert (alike > np.cos(np.radians(3))).mean() > 0.995, name


@pytest.mark.parametrize("scale", [1.0, 0.001, 0.01])
@pytest.mark.parametrize("template", ["c3x", "rotor"])
def test_meshes_at_any_scale_of_the_scene(template, scale):
    bpy.context.scene.unit_settings.scale_length = scale
    bpy.ops.coolinggen.new(template=template)
    collection = bpy.data.collections[template]
    sound(collection, scale)
    if template == "c3x":
        # The vane is 76.2 mm high.
        metal = solids(collection)["metal"]
        assert metal.dimensions.z * scale == pytest.approx(0.0762, rel=1e-5)


@pytest.mark.parametrize("path", SAMPLES, ids=lambda path: path.stem)
def test_designs_are_kept_as_they_were(path):
    design = json.loads(path.read_text(encoding="utf-8"))
    collection = blades().new(bpy.context.scene, design)
    assert json.dumps(blades().design(collection)) == json.dumps(design)


def test_what_is_the_users_stays(rotor):
    metal = solids(rotor)["metal"]
    own = bpy.data.materials.new("own")
    slot = blades().layers(metal.data).index("blade")
    metal.data.materials[slot] = own
    metal.modifiers.new("own", "BEVEL")
    metal["note"] = "own"
    mesh, before = metal.data, report(rotor)["solids"]["metal"]["volume_mm3"]
    rotor.coolinggen.design.cooling.shell.suction_side_varies = False
    rotor.coolinggen.design.cooling.shell.suction_side = 1.5
    assert bpy.ops.coolinggen.update() == {"FINISHED"}
    metal = solids(rotor)["metal"]
    assert report(rotor)["solids"]["metal"]["volume_mm3"] > before * 1.001
    assert metal.data == mesh and metal.data.materials[slot] == own
    assert "own" in metal.modifiers and metal["note"] == "own"
    used = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("material_index", used)
    assert (used == slot).any()


def test_solids_that_are_no_more_go(rotor):
    name = next(name for name in solids(rotor) if name.startswith("coolant/"))
    cooling = rotor.coolinggen.design.cooling
    bpy.ops.coolinggen.edit_list(path="cooling.walls", deed="REMOVE", index=len(cooling.walls) - 1)
    bpy.ops.coolinggen.edit_list(path="cooling.chambers", deed="REMOVE", index=1)
    assert bpy.ops.coolinggen.update() == {"FINISHED"}
    assert len(solids(rotor)) == 3 and name.startswith("coolant/")


def test_faces_have_names(rotor):
    metal = solids(rotor)["metal"]
    meshes = importlib.import_module(f"{MODULE}.meshes")
    names = meshes.face_names(metal.data)
    told = {face["name"]: face["area_mm2"] for face in report(rotor)["faces"] if face["name"] in names}
    number = np.empty(len(metal.data.polygons), np.int32)
    metal.data.attributes[meshes.FACE_ATTRIBUTE].data.foreach_get("value", number)
    areas = np.empty(len(metal.data.polygons), np.float32)
    metal.data.polygons.foreach_get("area", areas)
    assert len(told) == len(names)
    # A triangle's normal is within the angle of the surface's: its area is that much less at most.
    within = 1 - np.cos(np.radians(rotor.coolinggen.angle_deg))
    for k, name in enumerate(names):
        assert areas[number == k].sum() * 1e6 == pytest.approx(told[name], rel=within), name


def test_faces_are_selected_by_name(rotor):
    metal = solids(rotor)["metal"]
    bpy.context.view_layer.objects.active = metal
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.coolinggen.select_faces(pattern="blade/*") == {"FINISHED"}
    assert bpy.ops.coolinggen.select_faces(pattern="nothing") == {"CANCELLED"}
    bpy.ops.coolinggen.select_faces(pattern="blade/*")
    bpy.ops.object.mode_set(mode="OBJECT")
    chosen = sum(face.area for face in metal.data.polygons if face.select)
    blade = sum(face["area_mm2"] for face in report(rotor)["faces"] if face["name"].startswith("blade/"))
    assert chosen * 1e6 == pytest.approx(blade, rel=0.01)


def test_vertex_groups_of_faces_follow(rotor):
    meshes = importlib.import_module(f"{MODULE}.meshes")
    metal = solids(rotor)["metal"]
    bpy.context.view_layer.objects.active = metal
    metal.vertex_groups.new(name="own")
    assert bpy.ops.coolinggen.vertex_groups(pattern="chamber/*") == {"FINISHED"}

    def grouped() -> dict[str, set[int]]:
        names = [group.name for group in metal.vertex_groups]
        found = {name: set() for name in names}
        for vertex in metal.data.vertices:
            for entry in vertex.groups:
                assert entry.weight == 1.0
                found[names[entry.group]].add(vertex.index)
        return found

    def true() -> dict[str, set[int]]:
        names = meshes.face_names(metal.data)
        found = {name: set() for name in names if name.startswith("chamber/")}
        number = metal.data.attributes[meshes.FACE_ATTRIBUTE].data
        for polygon in metal.data.polygons:
            if (name := names[number[polygon.index].value]) in found:
                found[name] |= set(polygon.vertices)
        return found

    before = true()
    assert len(before) > 5 and grouped() == {"own": set(), **before}
    cooling = rotor.coolinggen.design.cooling
    bpy.ops.coolinggen.edit_list(path="cooling.walls", deed="REMOVE", index=len(cooling.walls) - 1)
    bpy.ops.coolinggen.edit_list(path="cooling.chambers", deed="REMOVE", index=1)
    assert bpy.ops.coolinggen.update() == {"FINISHED"}
    after = true()
    assert grouped() == {"own": set(), **after} and set(after) != set(before)
    assert bpy.ops.coolinggen.vertex_groups(pattern="") == {"FINISHED"}
    assert [group.name for group in metal.vertex_groups] == ["own"]


def test_walls_are_coloured_by_their_thickness(rotor):
    thickness = importlib.import_module(f"{MODULE}.thickness")
    scale = importlib.import_module(f"{MODULE}.client.thickness")
    metal, settings = solids(rotor)["metal"], rotor.coolinggen
    own = [slot.material for slot in metal.material_slots]
    assert bpy.ops.coolinggen.look(look="THICKNESS") == {"FINISHED"}
    values = thickness._read(metal.data)
    walls = values[values >= 0]
    least = report(rotor)["wall_thickness_mm"]["min"]
    # The report looks closer than at the corners of triangles.
    assert least - 1e-6 <= walls.min() < least + 0.2
    assert settings.thickness_low == pytest.approx(walls.min())
    assert settings.thickness_low < settings.thickness_high <= walls.max()
    assert (values < 0).any()

    def seen() -> np.ndarray:
        colors = np.empty(4 * len(values), np.float32)
        metal.data.color_attributes[thickness.COLORS].data.foreach_get("color", colors)
        return colors.reshape(-1, 4)

    def told(color) -> pytest.approx:
        return pytest.approx(thickness._linear(color), abs=0.02)

    assert metal.data.color_attributes.active_color.name == thickness.COLORS
    assert seen()[values.argmin()].tolist() == told(scale.NONE)
    assert seen()[np.where(values < 0, 99, values).argmin()].tolist() == told(scale.SCALE[0])
    assert seen()[values.argmax()].tolist() == told(scale.SCALE[-1])
    assert all(slot.material == settings.thickness_ramp for slot in metal.material_slots)
    assert solids(rotor)["coolant/leading"].hide_get()
    # The scale is the user's when it is taken.
    settings.thickness_auto = False
    settings.thickness_low = float(walls.max())
    assert seen()[values.argmax()].tolist() == told(scale.SCALE[0])
    rotor.coolinggen.design.cooling.shell.suction_side_varies = False
    rotor.coolinggen.design.cooling.shell.suction_side = 1.5
    assert bpy.ops.coolinggen.update() == {"FINISHED"}
    assert len(thickness._read(metal.data)) == len(metal.data.loops)
    assert settings.thickness_low == pytest.approx(float(walls.max()))
    assert bpy.ops.coolinggen.look(look="WHOLE") == {"FINISHED"}
    assert [slot.material for slot in metal.material_slots] == own
    assert {slot.link for slot in metal.material_slots} == {"DATA"}


def test_a_look_stays_when_the_blade_changes(rotor):
    design, names = blades().design(rotor), set(solids(rotor))
    bpy.ops.coolinggen.look(look="CUT")
    solids(rotor)["metal"].hide_set(True)
    cooling = rotor.coolinggen.design.cooling
    bpy.ops.coolinggen.edit_list(path="cooling.walls", deed="REMOVE", index=len(cooling.walls) - 1)
    bpy.ops.coolinggen.edit_list(path="cooling.chambers", deed="REMOVE", index=1)
    assert bpy.ops.coolinggen.update() == {"FINISHED"}
    gone = names - set(solids(rotor))
    blades().set_design(rotor, design)
    assert bpy.ops.coolinggen.update() == {"FINISHED"} and gone
    # What came is hidden as the look says, what the user has hidden is left so.
    assert all(solids(rotor)[name].hide_get() for name in (*gone, "metal"))


def test_looks(rotor):
    found = solids(rotor)
    for look in ("CUT", "GLASS", "COOLANT", "WHOLE"):
        assert bpy.ops.coolinggen.look(look=look) == {"FINISHED"}
        assert found["metal"].hide_get() == (look == "COOLANT")
        assert found["coolant/leading"].hide_get() == (look in ("CUT", "GLASS"))
        if look == "CUT":
            graph = bpy.context.evaluated_depsgraph_get()
            cut = found["metal"].evaluated_get(graph).to_mesh()
            # Half of the height is gone, and the cut is closed.
            assert measure.volume(cut) < 0.7 * measure.volume(found["metal"].data)
    assert not found["metal"].modifiers
    assert all(material.diffuse_color[3] == 1.0 for material in found["metal"].data.materials)


def test_turntable(rotor):
    assert bpy.ops.coolinggen.turntable(frames=8) == {"FINISHED"}
    scene = bpy.context.scene
    seen = set()
    for frame in range(1, 9):
        scene.frame_set(frame)
        seen.add(tuple(round(x, 5) for x in scene.camera.matrix_world.translation))
    assert len(seen) == 8 and scene.frame_end == 8


def test_an_export_that_fails_says_why(rotor, tmp_path):
    rotor.coolinggen.design.cooling.chambers[0].fillet_radius_varies = False
    rotor.coolinggen.design.cooling.chambers[0].fillet_radius = 500.0
    with pytest.raises(RuntimeError, match="/cooling/chambers/0/fillet_radius"):
        bpy.ops.coolinggen.export(directory=str(tmp_path))
    assert rotor.coolinggen.notice_is_bad and not list(tmp_path.iterdir())


def test_an_export_is_what_was_asked_for_and_leaves_no_model(rotor, tmp_path):
    service = importlib.import_module(f"{MODULE}.service")
    assert bpy.ops.coolinggen.export(directory=str(tmp_path), formats={"stl"}) == {"FINISHED"}
    assert "files in" in rotor.coolinggen.notice and not rotor.coolinggen.notice_is_bad
    assert not [name for name in service.sidecar("").call("model/list")["models"] if "export" in name]


def test_export(rotor, tmp_path):
    folder = tmp_path / "out of Blender \N{LATIN SMALL LETTER U WITH DIAERESIS}"
    assert bpy.ops.coolinggen.export(directory=str(folder), formats={"step", "stl"}) == {"FINISHED"}
    assert {path.suffix for path in folder.iterdir()} >= {".step", ".stl"}


def test_save_and_open_a_design(rotor, tmp_path):
    path = tmp_path / "rotor two.json"
    assert bpy.ops.coolinggen.save(filepath=str(path)) == {"FINISHED"}
    assert json.loads(path.read_text()) == json.loads((ROOT / "samples/rotor.json").read_text())
    assert bpy.ops.coolinggen.open(filepath=str(path)) == {"FINISHED"}
    assert len(blades().blades()) == 2
    assert not [each for each in Path(tmp_path).iterdir() if "unfinished" in each.name]


def test_rows_are_copied_with_a_name_of_their_own():
    bpy.ops.coolinggen.new(template="rotor-serpentine")
    collection = bpy.data.collections["rotor-serpentine"]
    rows = collection.coolinggen.design.cooling.film_rows
    before = [row.name for row in rows]
    assert bpy.ops.coolinggen.edit_list(path="cooling.film_rows", deed="COPY", index=0) == {"FINISHED"}
    after = [row.name for row in rows]
    assert after[:-1] == before and len(set(after)) == len(after)
    assert rows[len(before)].hole.diameter == rows[0].hole.diameter
