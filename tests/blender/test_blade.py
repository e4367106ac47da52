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


@pytest.mark.parametrize("template", ["rotor", "c3x", "rotor-serpentine", "propeller"])
def test_meshes(template):
    bpy.ops.coolinggen.new(template=template)
    collection = bpy.context.scene.collection.children[-1]
    told = report(collection)["solids"]
    assert set(solids(collection)) == set(told)
    for name, found in solids(collection).items():
        assert not found.data.validate(), name
        assert measure.closed(found.data), name
        # Chords lie within the tolerance of the surface.
        allowed = 1.01 * collection.coolinggen.chord_mm * told[name]["area_mm2"]
        assert abs(measure.volume(found.data) * 1e9 - told[name]["volume_mm3"]) < allowed, name
        given, flat = measure.normals(found.data)
        # The surface's normals, outward: nowhere far from those of the triangles.
        assert (np.einsum("ijk,ijk->ij", given, flat) > 0.5).mean() > 0.999, name


@pytest.mark.parametrize("scale", [1.0, 0.001, 0.01])
def test_size_at_any_scale_of_the_scene(scale):
    bpy.context.scene.unit_settings.scale_length = scale
    bpy.ops.coolinggen.new(template="c3x")
    metal = solids(bpy.data.collections["c3x"])["metal"]
    # The vane is 76.2 mm high.
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
