"""Vertex groups by the names of faces."""

import bpy
from bpy.props import StringProperty

from .. import blades, groups


class VertexGroups(bpy.types.Operator):
    """Gives the active solid a vertex group for each face whose name matches a pattern, and keeps them"""

    bl_idname = "coolinggen.vertex_groups"
    bl_label = "Vertex Groups of Faces"
    bl_options = {"REGISTER", "UNDO"}

    pattern: StringProperty(
        name="Name",
        description="As in blade/* or film/*; * stands for anything, nothing for no groups",
        default="*",
    )

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT" and context.object is not None and blades.SOLID in context.object

    def execute(self, context):
        count = groups.make(context.object, self.pattern)
        self.report({"INFO"}, f"{count} groups")
        return {"FINISHED"} if count or not self.pattern else {"CANCELLED"}


CLASSES = [VertexGroups]
