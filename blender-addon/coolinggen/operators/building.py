"""Having a blade follow its design."""

import bpy

from .. import blades, live
from .following import follow


class Update(bpy.types.Operator):
    """Builds the active blade as its design says"""

    bl_idname = "coolinggen.update"
    bl_label = "Update"

    @classmethod
    def poll(cls, context):
        return blades.active(context) is not None

    def execute(self, context):
        return follow(self, blades.active(context))


class Cancel(bpy.types.Operator):
    """Gives up what is being built; what is shown stays"""

    bl_idname = "coolinggen.cancel"
    bl_label = "Cancel"

    def execute(self, _context):
        live.cancel()
        return {"FINISHED"}


class Escape(bpy.types.Operator):
    """Listens for ESC while something is built"""

    bl_idname = "coolinggen.escape"
    bl_label = "Cancel with ESC"
    bl_options = {"INTERNAL"}

    listening = False

    def invoke(self, context, _event):
        Escape.listening = True
        self._timer = context.window_manager.event_timer_add(0.1, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if live.any_busy():
            if event.type == "ESC" and event.value == "PRESS":
                live.cancel()
                return {"RUNNING_MODAL"}
            return {"PASS_THROUGH"}
        self.cancel(context)
        return {"FINISHED", "PASS_THROUGH"}

    def cancel(self, context):
        Escape.listening = False
        context.window_manager.event_timer_remove(self._timer)


CLASSES = [Update, Cancel, Escape]
