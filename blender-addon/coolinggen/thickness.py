"""The thickness of walls as colours: an attribute of the corners, and a material that shows it."""

import json

import bpy
import numpy as np

from . import blades, live
from .client import thickness as scale
from .meshes import THICKNESS_ATTRIBUTE

#: Name of the colour attribute, for the solid view.
COLORS = "CoolingGen wall thickness"
#: The object's property with what its material slots had before, JSON.
BEFORE = "coolinggen_slots"
#: Names of the nodes of the material.
RAMP, RANGE = "Scale", "Range"


def measured(collection) -> bool:
    """Whether the blade's meshes say the thickness of walls."""
    return any(_has(solid) for solid in blades.objects(collection).values())


def show(collection) -> None:
    """Shows the blade's walls by their thickness, as far as it is known."""
    solids = [solid for solid in blades.objects(collection).values() if _has(solid)]
    known = [_read(solid.data) for solid in solids]
    settings = collection.coolinggen
    material = _material(collection)
    walls = np.sort(np.concatenate([values[values >= 0] for values in known] or [np.empty(0)]))
    if settings.thickness_auto and len(walls):
        with live.quiet():
            settings.thickness_low, settings.thickness_high = map(float, scale.span(walls))
    low, high = settings.thickness_low, max(settings.thickness_high, settings.thickness_low + 1e-6)
    nodes = material.node_tree.nodes
    nodes[RANGE].inputs["From Min"].default_value, nodes[RANGE].inputs["From Max"].default_value = low, high
    ramp = nodes[RAMP].color_ramp
    colors = np.array([*(ramp.evaluate(k / 255) for k in range(256)), _linear(scale.NONE)], np.float32)
    for solid, values in zip(solids, known, strict=True):
        place = np.clip((values - low) / (high - low), 0.0, 1.0) * 255
        _color(solid.data, colors[np.where(values < 0, 256, np.rint(place).astype(int))])
        _dress(solid, material)


def hide(collection) -> None:
    """Gives the solids back what their material slots had."""
    for solid in blades.objects(collection).values():
        for slot, (link, name) in zip(
            solid.material_slots, json.loads(solid.get(BEFORE, "[]")), strict=False
        ):
            slot.material = bpy.data.materials.get(name) if name else None
            slot.link = link
        if BEFORE in solid:
            del solid[BEFORE]


def recolour(settings, _context) -> None:
    """Told that the scale is another."""
    if settings.look == "THICKNESS" and not live.is_quiet():
        show(settings.id_data)


def ramp(collection):
    """The node with the scale of colours, for the panel; none if it was never made."""
    material = collection.coolinggen.thickness_ramp
    return material.node_tree.nodes.get(RAMP) if material is not None else None


def _has(solid) -> bool:
    return THICKNESS_ATTRIBUTE in solid.data.attributes


def _read(mesh) -> np.ndarray:
    values = np.empty(len(mesh.loops), np.float32)
    mesh.attributes[THICKNESS_ATTRIBUTE].data.foreach_get("value", values)
    return values


def _color(mesh, colors: np.ndarray) -> None:
    found = mesh.color_attributes.get(COLORS) or mesh.color_attributes.new(COLORS, "FLOAT_COLOR", "CORNER")
    found.data.foreach_set("color", colors.ravel())
    mesh.color_attributes.active_color = found


def _dress(solid, material) -> None:
    """Has the object show ``material``; the mesh, which may be shared, keeps its own."""
    before = json.loads(solid.get(BEFORE, "[]"))
    for slot in solid.material_slots[len(before) :]:
        own = slot.material if slot.link == "OBJECT" else None
        before.append([slot.link, own.name if own else ""])
        slot.link = "OBJECT"
        slot.material = material
    solid[BEFORE] = json.dumps(before)


def _material(collection):
    settings = collection.coolinggen
    if settings.thickness_ramp is not None:
        return settings.thickness_ramp
    made = settings.thickness_ramp = bpy.data.materials.new(f"CoolingGen wall thickness {collection.name}")
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shader = nodes["Principled BSDF"]
    shader.inputs["Roughness"].default_value = 0.6
    read = nodes.new("ShaderNodeAttribute")
    read.attribute_name = THICKNESS_ATTRIBUTE
    place = nodes.new("ShaderNodeMapRange")
    place.name = RANGE
    colors = nodes.new("ShaderNodeValToRGB")
    colors.name = RAMP
    elements = colors.color_ramp.elements
    for k, color in enumerate(scale.SCALE):
        at = k / (len(scale.SCALE) - 1)
        element = elements[-1] if k == len(scale.SCALE) - 1 else elements[0] if k == 0 else elements.new(at)
        element.position, element.color = at, _linear(color)
    wall = nodes.new("ShaderNodeMath")
    wall.operation = "GREATER_THAN"
    wall.inputs[1].default_value = -0.5
    choice = nodes.new("ShaderNodeMixRGB")
    choice.inputs["Color1"].default_value = _linear(scale.NONE)
    for number, node in enumerate((read, place, colors, choice)):
        node.location = 220 * number - 900, 300
    wall.location = -450, 60
    links.new(read.outputs["Fac"], place.inputs["Value"])
    links.new(place.outputs["Result"], colors.inputs["Fac"])
    links.new(read.outputs["Fac"], wall.inputs[0])
    links.new(wall.outputs["Value"], choice.inputs["Fac"])
    links.new(colors.outputs["Color"], choice.inputs["Color2"])
    links.new(choice.outputs["Color"], shader.inputs["Base Color"])
    return made


def _linear(color: scale.Color) -> tuple[float, float, float, float]:
    """A screen's colour as Blender reckons with it."""
    return (*(part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in color), 1.0)
