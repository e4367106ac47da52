"""Files of a blade for other programs, written by the sidecar."""

from pathlib import Path

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty

from .. import blades, live, service
from ..client.sidecar import SidecarError

FORMATS = [
    ("step", "STEP", "Exact solids for CAD"),
    ("glb", "glTF", "Meshes with materials"),
    ("obj", "OBJ", "Meshes with groups"),
    ("stl", "STL", "Meshes with named regions"),
]


class Export(bpy.types.Operator):
    """Writes the active blade's solids into a folder, exact where the format can be"""

    bl_idname = "coolinggen.export"
    bl_label = "Export Solids"

    directory: StringProperty(name="Folder", subtype="DIR_PATH")
    filter_folder: BoolProperty(default=True, options={"HIDDEN"})
    formats: EnumProperty(name="Formats", items=FORMATS, options={"ENUM_FLAG"}, default={"step"})

    @classmethod
    def poll(cls, context):
        return blades.active(context) is not None

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        collection = blades.active(context)
        order = blades.order(collection)
        folder = Path(bpy.path.abspath(self.directory)).resolve()
        tolerances = {"chord_mm": order.chord_mm, "angle_deg": order.angle_deg}
        if not blades.up_to_date(collection):
            live.update(collection)
        if collection.coolinggen.failure:
            self.report({"ERROR"}, collection.coolinggen.failure)
            return {"CANCELLED"}
        try:
            server = service.sidecar(service.preferred())
            if order.model not in server.call("model/list")["models"]:
                where = {"folder": order.folder} if order.folder else {}
                server.call("design/generate", model=order.model, design=order.design, report=False, **where)
            written = server.call(
                "model/export",
                model=order.model,
                folder=str(folder),
                formats=sorted(self.formats),
                **tolerances,
            )
        except SidecarError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"{len(written['files'])} files in {folder}")
        return {"FINISHED"}


CLASSES = [Export]
