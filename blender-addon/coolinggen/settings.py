"""What a blade's collection keeps: its design, how it is shown, what was measured. All is in the file."""

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    PointerProperty,
    StringProperty,
)

from . import properties
from .live import changed
from .schema import FORM
from .views import LOOKS

_DESIGN = properties.classes(FORM)


class Fault(bpy.types.PropertyGroup):
    """Something that is wrong with a design."""

    pointer: StringProperty(name="Where")
    message: StringProperty(name="What")
    hint: StringProperty(name="Hint")


class BladeSettings(bpy.types.PropertyGroup):
    """A collection's blade."""

    is_blade: BoolProperty(name="Is a cooled blade")
    live: BoolProperty(
        name="Live", description="Follow every change of the design", default=True, update=changed
    )
    chord_mm: FloatProperty(
        name="Chord tolerance",
        description="Greatest distance between mesh and surface, mm",
        default=0.05,
        min=0.001,
        max=10.0,
        precision=3,
        update=changed,
    )
    angle_deg: FloatProperty(
        name="Angle tolerance",
        description="Greatest angle between neighbouring normals of the mesh, degrees",
        default=15.0,
        min=1.0,
        max=90.0,
        precision=1,
        update=changed,
    )
    look: EnumProperty(name="Look", items=LOOKS)
    design: PointerProperty(type=_DESIGN[-1])
    source: StringProperty(name="Design", description="The design that the properties were set from, JSON")
    folder: StringProperty(
        name="Folder",
        description="Where relative paths in the design begin",
        subtype="DIR_PATH",
        update=changed,
    )
    built: StringProperty(name="Built", description="Mark of the design that is shown")
    report: StringProperty(name="Report", description="What was measured, JSON")
    failure: StringProperty(name="Failure", description="Why the design is not shown")
    faults: CollectionProperty(type=Fault)


CLASSES = [*_DESIGN, Fault, BladeSettings]


def register() -> None:
    """Gives collections blades."""
    for kind in CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.Collection.coolinggen = PointerProperty(type=BladeSettings)


def unregister() -> None:
    """Takes them away; what files keep stays in them."""
    del bpy.types.Collection.coolinggen
    for kind in reversed(CLASSES):
        bpy.utils.unregister_class(kind)
