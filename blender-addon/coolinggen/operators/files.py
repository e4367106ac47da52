"""Files of a blade for other programs, written by the sidecar beside the window."""

from functools import partial
from pathlib import Path

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty

from .. import beside, blades, building, live, service
from ..client.formats import FORMATS
from ..client.latest import Done
from .following import ended

ITEMS = [(name, *words) for name, words in FORMATS.items()]


class Export(bpy.types.Operator):
    """Writes the active blade's solids into a folder, exact where the format can be"""

    bl_idname = "coolinggen.export"
    bl_label = "Export Solids"

    directory: StringProperty(name="Folder", subtype="DIR_PATH")
    filter_folder: BoolProperty(default=True, options={"HIDDEN"})
    formats: EnumProperty(name="Formats", items=ITEMS, options={"ENUM_FLAG"}, default={"step"})

    @classmethod
    def poll(cls, context):
        return blades.active(context) is not None

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        collection = blades.active(context)
        order, preferred = blades.order(collection), service.preferred()
        folder = Path(bpy.path.abspath(self.directory)).resolve()
        formats = sorted(self.formats)
        key = collection.session_uid, "export"
        beside.start(
            key,
            lambda watch: building.export(order, folder, formats, lambda: service.sidecar(preferred), watch),
            partial(_ended, collection.session_uid, folder),
        )
        return ended(self, collection, key)


def _ended(uid: int, folder: Path, done: Done):
    if done.error is None:
        told = f"{len(done.result)} files in {folder}"
    else:
        told = f"Not exported: {live.reason(done.error)}"
    yield live.with_blade(uid, lambda collection: blades.tell(collection, told, bad=done.error is not None))


CLASSES = [Export]
