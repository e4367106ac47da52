"""How a blade is looked at: cut open, with glassy metal, its coolant alone; a camera that goes round it."""

import contextlib
import math

import bpy
from mathutils import Vector

from . import blades, thickness

LOOKS = [
    ("WHOLE", "Whole", "All solids"),
    ("CUT", "Cut open", "All solids, cut through by a plane that can be moved"),
    ("GLASS", "Glass", "The metal see-through, the walls of its passages not"),
    ("COOLANT", "Coolant", "The coolant alone"),
    ("THICKNESS", "Thickness", "The metal by the thickness of its walls"),
]
#: Looks for which the coolant would hide what is to be seen: the walls of the passages.
WITHOUT_COOLANT = ("CUT", "GLASS", "THICKNESS")

#: The object's property with the look that it was last given.
SHOWN = "coolinggen_look"
#: Name of the modifier that cuts a solid open.
CUT = "CoolingGen cut"
#: The object's property that marks the body that cuts.
CUTTER = "coolinggen_cutter"
#: Opacity of glassy metal.
GLASSY = 0.15
#: The material's property with its opacity when it is not glass.
OPAQUE = "coolinggen_alpha"


def show(collection, look: str) -> None:
    """Shows the blade in ``collection`` as ``look`` says."""
    collection.coolinggen.look = look
    for solid in blades.objects(collection).values():
        solid.pop(SHOWN, None)
    again(collection)


def again(collection) -> None:
    """Shows what a blade got since its look was chosen as that says; the rest stays as the user has it."""
    look = collection.coolinggen.look
    solids = blades.objects(collection)
    cutter = _cutter(collection) if look == "CUT" and solids else None
    wetted = {
        layer for name, found in solids.items() if _is_coolant(name) for layer in blades.layers(found.data)
    }
    for name, found in solids.items():
        inside = _is_coolant(name)
        if found.get(SHOWN) != look:
            found[SHOWN] = look
            hidden = inside if look in WITHOUT_COOLANT else look == "COOLANT" and not inside
            # Where its collection is left out of the view layer, nothing has to be hidden.
            with contextlib.suppress(RuntimeError):
                found.hide_set(hidden)
            found.hide_render = hidden
            _cut(found, cutter)
        if not inside:
            for layer, material in zip(blades.layers(found.data), found.data.materials, strict=False):
                _glass(material, look == "GLASS" and layer not in wetted)
    if look == "THICKNESS":
        thickness.show(collection)
    else:
        thickness.hide(collection)


def _is_coolant(solid: str) -> bool:
    return solid.split("/")[0] == "coolant"


def _cutter(collection):
    """The body that takes half of the blade away; the user may move it."""
    found = next((each for each in collection.objects if CUTTER in each), None)
    if found is not None:
        return found
    corners = [Vector(corner) for solid in blades.objects(collection).values() for corner in solid.bound_box]
    low, high = Vector(map(min, zip(*corners, strict=True))), Vector(map(max, zip(*corners, strict=True)))
    middle, size = (low + high) / 2, (high - low) * 1.1
    mesh = bpy.data.meshes.new("CoolingGen cutter")
    points = [
        middle + Vector((x * size.x, y * size.y, z * size.z / 2 + size.z / 4))
        for x in (-0.5, 0.5)
        for y in (-0.5, 0.5)
        for z in (-0.5, 0.5)
    ]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(points, [], faces)
    found = bpy.data.objects.new("CoolingGen cutter", mesh)
    found[CUTTER] = True
    found.display_type = "WIRE"
    found.hide_render = True
    collection.objects.link(found)
    return found


def _cut(solid, cutter) -> None:
    modifier = solid.modifiers.get(CUT)
    if cutter is None:
        if modifier is not None:
            solid.modifiers.remove(modifier)
        return
    if modifier is None:
        modifier = solid.modifiers.new(CUT, "BOOLEAN")
    modifier.operation = "DIFFERENCE"
    modifier.object = cutter
    solvers = modifier.bl_rna.properties["solver"].enum_items.keys()
    # Closed meshes, each by itself: what the manifold solver is for, where Blender has it.
    modifier.solver = "MANIFOLD" if "MANIFOLD" in solvers else "EXACT"


def _glass(material, on: bool) -> None:
    if material is None or not material.use_nodes:
        return
    shader = material.node_tree.nodes.get("Principled BSDF")
    if shader is None or on == (OPAQUE in material):
        return
    alpha = shader.inputs["Alpha"]
    if on:
        material[OPAQUE] = alpha.default_value
        alpha.default_value = GLASSY
    else:
        alpha.default_value = material[OPAQUE]
        del material[OPAQUE]
    material.diffuse_color[3] = alpha.default_value
    if hasattr(material, "surface_render_method"):
        material.surface_render_method = "BLENDED" if on else "DITHERED"


def turntable(scene, corners: list[Vector], frames: int, elevation: float) -> None:
    """A camera and a sun that go once round the box of ``corners`` in so many frames, all of it in view."""
    low, high = Vector(map(min, zip(*corners, strict=True))), Vector(map(max, zip(*corners, strict=True)))
    middle, (across, height) = (low + high) / 2, ((high - low).xy.length / 2, (high - low).z / 2)
    pivot = bpy.data.objects.new("CoolingGen turntable", None)
    scene.collection.objects.link(pivot)
    pivot.location = middle
    camera = bpy.data.objects.new("CoolingGen camera", bpy.data.cameras.new("CoolingGen camera"))
    # The field of view is the picture's greater side's.
    wide, tall = scene.render.resolution_x, scene.render.resolution_y
    tangent = math.tan(camera.data.angle / 2) / max(wide, tall)
    up = height * math.cos(elevation) + across * abs(math.sin(elevation))
    distance = 1.05 * (across + max(across / (tangent * wide), up / (tangent * tall)))
    camera.data.clip_start, camera.data.clip_end = distance * 1e-3, distance * 10
    camera.location = distance * Vector((0, -math.cos(elevation), math.sin(elevation)))
    camera.rotation_euler = (math.pi / 2 - elevation, 0, 0)
    lamp = bpy.data.objects.new("CoolingGen sun", bpy.data.lights.new("CoolingGen sun", "SUN"))
    lamp.data.energy = 3.0
    lamp.rotation_euler = (math.radians(50), math.radians(15), math.radians(30))
    for each in (camera, lamp):
        each.parent = pivot
        scene.collection.objects.link(each)
    scene.camera = camera
    scene.frame_start, scene.frame_end = 1, frames
    for frame, angle in ((1, 0.0), (frames + 1, 2 * math.pi)):
        pivot.rotation_euler.z = angle
        pivot.keyframe_insert("rotation_euler", index=2, frame=frame)
    _evenly(pivot)


def _evenly(pivot) -> None:
    """Lets the keyed values change evenly between the keys."""
    animation = pivot.animation_data
    action = animation.action
    if hasattr(action, "fcurves"):
        curves = action.fcurves
    else:
        curves = action.layers[0].strips[0].channelbag(animation.action_slot).fcurves
    for curve in curves:
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"
