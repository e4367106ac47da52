"""Ways to look inside a blade, and to have a picture of it."""

import math

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty
from mathutils import Vector

from .. import blades, thickness, views
from .following import follow


class Look(bpy.types.Operator):
    """Shows the active blade whole, cut open, in glass, its coolant alone, or its walls by their thickness"""

    bl_idname = "coolinggen.look"
    bl_label = "Look"
    bl_options = {"REGISTER", "UNDO"}

    look: EnumProperty(name="Look", items=views.LOOKS)

    @classmethod
    def poll(cls, context):
        return blades.active(context) is not None

    def execute(self, context):
        collection = blades.active(context)
        views.show(collection, self.look)
        _shade(context.space_data, self.look)
        if self.look == "THICKNESS" and not thickness.measured(collection):
            return follow(self, collection)
        return {"FINISHED"}


def _shade(space, look: str) -> None:
    """Lets a solid view show the walls' colours, and the materials' again."""
    if space is None or space.type != "VIEW_3D":
        return
    if look == "THICKNESS":
        space.shading.color_type = "VERTEX"
    elif space.shading.color_type == "VERTEX":
        space.shading.color_type = "MATERIAL"


class Turntable(bpy.types.Operator):
    """A camera that goes once round the active blade, and lights"""

    bl_idname = "coolinggen.turntable"
    bl_label = "Turntable"
    bl_options = {"REGISTER", "UNDO"}

    frames: IntProperty(name="Frames", default=120, min=2)
    elevation: FloatProperty(name="Elevation", subtype="ANGLE", default=math.radians(20))

    @classmethod
    def poll(cls, context):
        collection = blades.active(context)
        return collection is not None and bool(blades.objects(collection))

    def execute(self, context):
        collection = blades.active(context)
        corners = [
            found.matrix_world @ Vector(corner)
            for found in blades.objects(collection).values()
            for corner in found.bound_box
        ]
        views.turntable(context.scene, corners, self.frames, self.elevation)
        return {"FINISHED"}


CLASSES = [Look, Turntable]
