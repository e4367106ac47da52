"""Materials of a blade's layers."""

import bpy

#: Roughness and metallic of the principled shader, by the first part of a solid's name.
LOOKS = {
    "metal": (0.35, 1.0),
    "insert": (0.25, 1.0),
    "coolant": (0.5, 0.0),
    "hub": (0.45, 1.0),
    "shroud": (0.45, 1.0),
}


def material(solid: str, layer: str, color: tuple[float, float, float]):
    """The material of a layer of a solid, made when it is not there yet."""
    kind = solid.split("/")[0]
    name = f"CoolingGen {kind} {layer}"
    found = bpy.data.materials.get(name)
    if found is not None:
        return found
    roughness, metallic = LOOKS.get(kind, LOOKS["metal"])
    made = bpy.data.materials.new(name)
    made.diffuse_color = (*color, 1.0)
    # The viewport's metals mirror a dark studio.
    made.roughness, made.metallic = roughness, 0.0
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    shader.inputs["Roughness"].default_value = roughness
    shader.inputs["Metallic"].default_value = metallic
    return made
