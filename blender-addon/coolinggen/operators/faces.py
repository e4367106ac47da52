"""Faces by their names."""

import fnmatch

import bmesh
import bpy
from bpy.props import BoolProperty, StringProperty

from ..meshes import FACE_ATTRIBUTE, face_names


class SelectFaces(bpy.types.Operator):
    """Selects the faces whose names match a pattern, in the mesh that is edited"""

    bl_idname = "coolinggen.select_faces"
    bl_label = "Select Faces by Name"
    bl_options = {"REGISTER", "UNDO"}

    pattern: StringProperty(
        name="Name", description="As in blade/* or film/*/exit; * stands for anything", default="blade/*"
    )
    extend: BoolProperty(name="Extend", description="Keep what is selected")

    @classmethod
    def poll(cls, context):
        return context.mode == "EDIT_MESH" and FACE_ATTRIBUTE in context.object.data.attributes

    def execute(self, context):
        mesh = context.object.data
        names = face_names(mesh)
        wanted = {k for k, name in enumerate(names) if fnmatch.fnmatchcase(name, self.pattern)}
        edited = bmesh.from_edit_mesh(mesh)
        layer = edited.faces.layers.int[FACE_ATTRIBUTE]
        for face in edited.faces:
            if face[layer] in wanted:
                face.select = True
            elif not self.extend:
                face.select = False
        edited.select_flush_mode()
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
        self.report({"INFO"}, f"{len(wanted)} of {len(names)} faces")
        return {"FINISHED"} if wanted else {"CANCELLED"}


CLASSES = [SelectFaces]
