"""What a blade's collection keeps: its design, how it is shown, what was measured. All is in the file."""

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from . import properties
from .live import changed
from .schema import FORM
from .thickness import recolour
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
    notice: StringProperty(
        name="Notice", description="What came of the last thing done", options={"SKIP_SAVE"}
    )
    notice_is_bad: BoolProperty(options={"SKIP_SAVE"})
    fit_mm: FloatProperty(
        name="Fit", description="Greatest distance of the object's points from the blade, mm", default=-1.0
    )
    fit_points: IntProperty(name="Points", description="How many points of the object were compared")
    fit_at: FloatVectorProperty(name="Where", description="The farthest of them", subtype="TRANSLATION")
    thickness_ramp: PointerProperty(
        name="Wall thickness", description="The material of the walls' colours", type=bpy.types.Material
    )
    thickness_auto: BoolProperty(
        name="Auto",
        description="The scale reaches as far as the walls' thickness",
        default=True,
        update=recolour,
    )
    thickness_low: FloatProperty(
        name="From", description="Thickness of the first colour, mm", min=0.0, precision=3, update=recolour
    )
    thickness_high: FloatProperty(
        name="To", description="Thickness of the last colour, mm", min=0.0, precision=3, update=recolour
    )


CLASSES = [*_DESIGN, Fault, BladeSettings]

_register, _unregister = bpy.utils.register_classes_factory(CLASSES)


def register() -> None:
    """Gives collections blades."""
    _register()
    bpy.types.Collection.coolinggen = PointerProperty(type=BladeSettings)


def unregister() -> None:
    """Takes them away; what files keep stays in them."""
    del bpy.types.Collection.coolinggen
    _unregister()
