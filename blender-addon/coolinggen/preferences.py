"""Where the sidecar is."""

import bpy
from bpy.props import StringProperty

from . import service
from .client.sidecar import SidecarError


class Preferences(bpy.types.AddonPreferences):
    """The add-on's preferences."""

    bl_idname = __package__

    binary: StringProperty(
        name="coolinggen",
        description="The program; the one packed into the add-on, or that on the PATH, if this is empty",
        subtype="FILE_PATH",
    )
    tested: StringProperty(options={"SKIP_SAVE"})

    def draw(self, _context):
        self.layout.prop(self, "binary")
        row = self.layout.row()
        row.operator("coolinggen.test")
        row.label(text=self.tested)


class Test(bpy.types.Operator):
    """Starts the sidecar and says its version"""

    bl_idname = "coolinggen.test"
    bl_label = "Test"

    def execute(self, context):
        addon = context.preferences.addons[__package__].preferences
        service.stop()
        try:
            server = service.sidecar(service.preferred()).server["server"]
        except SidecarError as error:
            addon.tested = str(error)
            self.report({"ERROR"}, addon.tested)
            return {"CANCELLED"}
        addon.tested = f"{server['name']} {server['version']}"
        self.report({"INFO"}, addon.tested)
        return {"FINISHED"}


CLASSES = [Test, Preferences]

register, unregister = bpy.utils.register_classes_factory(CLASSES)
