"""Where designs come from and go to."""

import json
from pathlib import Path

import bpy
from bpy.props import EnumProperty, StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper

from .. import blades
from ..templates import TEMPLATES
from .following import follow


def begin(operator, context, design: dict, folder: str) -> set[str]:
    """Makes a blade of ``design`` the active one and builds it: beside the window where there is one."""
    collection = blades.new(context.scene, design, folder)
    layer = context.view_layer.layer_collection.children.get(collection.name)
    if layer is not None:
        context.view_layer.active_layer_collection = layer
    return follow(operator, collection)


class NewBlade(bpy.types.Operator):
    """A cooled blade from a template"""

    bl_idname = "coolinggen.new"
    bl_label = "New from Template"
    bl_options = {"REGISTER", "UNDO"}

    template: EnumProperty(name="Template", items=[(name, name, about) for name, about in TEMPLATES])

    def execute(self, context):
        path = Path(__file__).parent.parent / "templates" / f"{self.template}.json"
        design = json.loads(path.read_text(encoding="utf-8"))
        return begin(self, context, design, str(path.parent))


class OpenDesign(bpy.types.Operator, ImportHelper):
    """A cooled blade from a design file"""

    bl_idname = "coolinggen.open"
    bl_label = "Open Design"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})

    def execute(self, context):
        path = Path(self.filepath)
        try:
            design = json.loads(path.read_text(encoding="utf-8"))
            if not isinstance(design, dict):
                raise ValueError("it is no design")
            return begin(self, context, design, str(path.parent))
        except (OSError, ValueError, KeyError, TypeError, StopIteration) as error:
            self.report({"ERROR"}, f"{path.name}: {error}")
            return {"CANCELLED"}


class SaveDesign(bpy.types.Operator, ExportHelper):
    """The active blade's design as a file"""

    bl_idname = "coolinggen.save"
    bl_label = "Save Design"

    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})

    @classmethod
    def poll(cls, context):
        return blades.active(context) is not None

    def execute(self, context):
        path = Path(self.filepath)
        text = json.dumps(blades.design(blades.active(context)), indent=2) + "\n"
        # Whole or not at all.
        unfinished = path.with_name(f".{path.name}.unfinished")
        try:
            unfinished.write_text(text, encoding="utf-8")
            unfinished.replace(path)
        except OSError as error:
            unfinished.unlink(missing_ok=True)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


CLASSES = [NewBlade, OpenDesign, SaveDesign]
