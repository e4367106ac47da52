"""The pictures of docs/blender.md and the first of README.md, made by the extension itself in Blender's
module, with Cycles.

tests/install && cd tests && .venv-bpy4.5/bin/python render/blender.py [NAME...]
"""

from __future__ import annotations

import argparse
import importlib
import math
import sys
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "blender"))

# The first says where Blender's settings are before Blender is there.
import conftest  # noqa: E402, I001
import bpy  # noqa: E402
from mathutils import Matrix, Vector  # noqa: E402

TEMPLATE = "rotor-serpentine"


def scene(width: int, height: int, sky: tuple[float, float, float]):
    """An empty scene with an even sky."""
    bpy.ops.wm.read_homefile(use_empty=True)
    made = bpy.context.scene
    made.render.resolution_x, made.render.resolution_y = width, height
    made.render.engine, made.cycles.use_denoising = "CYCLES", True
    made.view_settings.view_transform = "Standard"
    made.world = bpy.data.worlds.new("sky")
    made.world.use_nodes = True
    made.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*sky, 1.0)
    return made


def look(name: str) -> None:
    """A blade on the turntable, as it looks."""
    made = scene(480, 480, (0.75, 0.8, 0.88))
    bpy.ops.coolinggen.new(template=TEMPLATE)
    bpy.ops.coolinggen.turntable(frames=12)
    if name == "THICKNESS":
        # Colours have one value a vertex.
        bpy.data.collections[TEMPLATE].coolinggen.angle_deg = 2.0
    bpy.ops.coolinggen.look(look=name)
    made.frame_set(1)


def hero() -> None:
    """Three blades in a dark studio: metal, glass round its passages, the coolant."""
    made = scene(1000, 500, (0.012, 0.016, 0.024))
    made.view_settings.view_transform, made.view_settings.look = "AgX", "AgX - Medium High Contrast"
    made.cycles.max_bounces, made.cycles.transparent_max_bounces = 4, 12
    for place, name in ((-0.052, "WHOLE"), (0.0, "GLASS"), (0.052, "COOLANT")):
        bpy.ops.coolinggen.new(template=TEMPLATE)
        collection = next(each for each in bpy.data.collections if not each.get("placed"))
        collection["placed"] = True
        stand(collection, Vector((place, 0.0, 0.0)), name)
    floor()
    lamps()
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    made.collection.objects.link(camera)
    made.camera = camera
    camera.data.lens = 85
    camera.location = Vector((0.03, -0.4, 0.13))
    camera.rotation_euler = (
        (Vector((0.001, 0.0, 0.029)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    )


def stand(collection, place: Vector, name: str) -> None:
    """Puts a blade with the middle of its foot at ``place``, turned a little, in this picture's materials."""
    blades = importlib.import_module(f"{conftest.MODULE}.blades")
    solids = list(blades.objects(collection).values())
    wetted = {
        layer
        for solid in solids
        if solid[blades.SOLID].startswith("coolant")
        for layer in blades.layers(solid.data)
    }
    corners = [Vector(corner) for solid in solids for corner in solid.bound_box]
    low, high = Vector(map(min, zip(*corners, strict=True))), Vector(map(max, zip(*corners, strict=True)))
    foot = Vector(((low.x + high.x) / 2, (low.y + high.y) / 2, low.z))
    move = Matrix.Translation(place) @ Matrix.Rotation(math.radians(TURN), 4, "Z") @ Matrix.Translation(-foot)
    for solid in solids:
        solid.matrix_world = move
        coolant = solid[blades.SOLID].startswith("coolant")
        solid.hide_render = coolant != (name == "COOLANT")
        for slot, layer in zip(solid.material_slots, blades.layers(solid.data), strict=True):
            slot.link = "OBJECT"
            # The walls of the passages are the coolant's, which itself is left out in glass.
            slot.material = material("coolant" if layer in wetted and name != "WHOLE" else name.lower())


#: Of the blades about the vertical, degrees.
TURN = -6


def material(key: str):
    """Brushed nickel for the whole blade, clear glass, or a coolant that glows."""
    found = bpy.data.materials.get(f"hero {key}")
    if found is not None:
        return found
    made = bpy.data.materials.new(f"hero {key}")
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"].inputs
    if key == "whole":
        shader["Base Color"].default_value = (0.75, 0.72, 0.68, 1.0)
        shader["Metallic"].default_value, shader["Roughness"].default_value = 1.0, 0.36
    elif key == "glass":
        shader["Base Color"].default_value = (0.85, 0.93, 1.0, 1.0)
        shader["Roughness"].default_value, shader["Alpha"].default_value = 0.04, 0.1
        shader["Metallic"].default_value = 0.4
    else:
        shader["Base Color"].default_value = (0.008, 0.14, 0.55, 1.0)
        shader["Roughness"].default_value = 0.25
        shader["Emission Color"].default_value = (0.01, 0.1, 0.5, 1.0)
        shader["Emission Strength"].default_value = 0.06
    return made


def floor() -> None:
    """A dark floor that mirrors a little."""
    bpy.ops.mesh.primitive_plane_add(size=6)
    made = bpy.data.materials.new("floor")
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"].inputs
    shader["Base Color"].default_value = (0.02, 0.024, 0.03, 1.0)
    shader["Roughness"].default_value = 0.22
    bpy.context.object.data.materials.append(made)


def lamps() -> None:
    """A wide key from the left, a cold rim from behind on the right, a warm one on the left."""
    for place, size, watts, color in (
        ((-0.3, -0.45, 0.4), (0.4, 0.5), 5.5, (1.0, 0.97, 0.92)),
        ((0.45, 0.2, 0.3), (0.15, 0.6), 5.0, (0.6, 0.78, 1.0)),
        ((-0.45, 0.3, 0.2), (0.12, 0.5), 3.5, (1.0, 0.62, 0.35)),
        ((0.1, -0.3, 0.7), (0.6, 0.2), 2.0, (1.0, 1.0, 1.0)),
    ):
        lamp = bpy.data.lights.new("lamp", "AREA")
        lamp.shape, lamp.size, lamp.size_y, lamp.energy, lamp.color = "RECTANGLE", *size, watts, color
        made = bpy.data.objects.new("lamp", lamp)
        made.location = place
        made.rotation_euler = (Vector((0, 0, 0.03)) - made.location).to_track_quat("-Z", "Y").to_euler()
        bpy.context.scene.collection.objects.link(made)


#: What makes the scene of each picture, and how many samples a point it takes.
PICTURES: dict[str, tuple[Callable[[], None], int]] = {
    "whole": (lambda: look("WHOLE"), 8),
    "cut": (lambda: look("CUT"), 8),
    "glass": (lambda: look("GLASS"), 8),
    "coolant": (lambda: look("COOLANT"), 8),
    "thickness": (lambda: look("THICKNESS"), 8),
    "hero": (hero, 12),
}


def main() -> None:
    """Makes pictures, all if none is named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(PICTURES))
    parser.add_argument("--folder", type=Path, default=ROOT / "docs" / "gallery" / "blender")
    parser.add_argument("--samples", type=int, help="a point, instead of each picture's own")
    parser.add_argument("--percent", type=int, default=100, help="of the size")
    options = parser.parse_args()
    if unknown := set(options.names) - set(PICTURES):
        parser.error(f"there is no picture {', '.join(sorted(unknown))}")
    conftest.install()
    importlib.import_module(conftest.MODULE)
    for name in options.names or PICTURES:
        make, samples = PICTURES[name]
        make()
        render = bpy.context.scene.render
        bpy.context.scene.cycles.samples = options.samples or samples
        render.resolution_percentage = options.percent
        render.image_settings.color_mode, render.image_settings.compression = "RGB", 100
        render.filepath = str(options.folder / f"{name}.png")
        bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main()
