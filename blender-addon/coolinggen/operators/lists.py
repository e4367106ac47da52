"""Things of a design's lists: chambers, walls, rows, slots, inserts and so on."""

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty

from .. import blades, live, values
from ..client import forms
from ..properties import word
from ..schema import FORM


class EditList(bpy.types.Operator):
    """Adds, copies, takes away or moves a thing of a list"""

    bl_idname = "coolinggen.edit_list"
    bl_label = "Edit List"
    bl_options = {"REGISTER", "UNDO"}

    path: StringProperty(name="List", description="Where it is: keys of the design with points between them")
    deed: EnumProperty(
        name="Deed",
        items=[
            ("ADD", "Add", "Add one"),
            ("COPY", "Copy", "Add a copy of the chosen one"),
            ("REMOVE", "Remove", "Take the chosen one away"),
            ("UP", "Up", "Move the chosen one up"),
            ("DOWN", "Down", "Move the chosen one down"),
        ],
    )
    index: IntProperty(name="Which", default=-1, description="The chosen one if negative")

    @classmethod
    def poll(cls, context):
        return blades.active(context) is not None

    def execute(self, context):
        collection = blades.active(context)
        owner, key = _owner(collection.coolinggen.design, self.path)
        things = getattr(owner, key)
        chosen = self.index if self.index >= 0 else getattr(owner, f"{key}_index", 0)
        if self.deed != "ADD" and not 0 <= chosen < len(things):
            return {"CANCELLED"}
        with live.quiet():
            chosen = self._edit(things, chosen, item_shape(self.path))
            if hasattr(owner, f"{key}_index"):
                setattr(owner, f"{key}_index", max(0, min(chosen, len(things) - 1)))
        live.changed(owner, context)
        return {"FINISHED"}

    def _edit(self, things, chosen: int, shape: forms.Shape | None) -> int:
        match self.deed:
            case "REMOVE":
                things.remove(chosen)
                return chosen
            case "UP" | "DOWN":
                to = chosen + (1 if self.deed == "DOWN" else -1)
                if 0 <= to < len(things):
                    things.move(chosen, to)
                    return to
                return chosen
        taken = {getattr(each, "name", "") for each in things}
        thing = things.add()
        if isinstance(shape, forms.Group):
            last = things[chosen] if self.deed == "COPY" else None
            value = values.read(last, shape, {}) if last else forms.blank(shape)
            if "name" in value:
                value["name"] = _free(value["name"] or self.path.split(".")[-1].removesuffix("s"), taken)
            values.write(thing, shape, value)
        elif self.deed == "COPY":
            for name in thing.bl_rna.properties.keys():  # noqa: SIM118 (no dictionary)
                if name not in ("rna_type", "name"):
                    setattr(thing, name, getattr(things[chosen], name))
        return len(things) - 1


def item_shape(path: str) -> forms.Shape | None:
    """The shape of the things in the list at ``path``; none for the rows of a law."""
    shape: forms.Shape = FORM
    for key in path.split("."):
        name = key.split("[")[0]
        shape = _part(shape, name)
        if isinstance(shape, forms.List):
            shape = shape.item
    return shape if isinstance(shape, forms.Group | forms.Text) else None


def _part(shape: forms.Shape, name: str) -> forms.Shape | None:
    if not isinstance(shape, forms.Group):
        return None
    for field in shape.fields:
        if field.key == name:
            return field.shape
        if isinstance(field.shape, forms.Variants) and name.startswith(f"{field.key}_"):
            for kind, _, group in field.shape.options:
                if name == f"{field.key}_{word(kind)}":
                    return group
    return None


def _owner(design, path: str):
    holder, _, key = path.rpartition(".")
    return (design.path_resolve(holder) if holder else design), key


def _free(name: str, taken: set[str]) -> str:
    stem = name.rstrip("0123456789").rstrip("_")
    number = 1
    while name in taken:
        number += 1
        name = f"{stem}_{number}"
    return name


CLASSES = [EditList]
