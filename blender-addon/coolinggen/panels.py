"""The panel "CoolingGen" in the viewport's sidebar: made from the form, a part a panel."""

import json

import bpy

from . import blades, live, thickness
from .client import forms
from .properties import switched, word
from .schema import FORM
from .views import LOOKS


class Sidebar:
    """What all panels have in common."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "CoolingGen"


class Main(Sidebar, bpy.types.Panel):
    """What can be done with the active blade, and what is wrong with it"""

    bl_idname = "COOLINGGEN_PT_main"
    bl_label = "Cooled Blade"

    def draw(self, context):
        layout = self.layout
        row = layout.row(align=True)
        row.operator_menu_enum("coolinggen.new", "template", text="New")
        row.operator("coolinggen.open", text="Open")
        row.operator("coolinggen.from_object", text="Object")
        collection = blades.active(context)
        if collection is None:
            layout.label(text="No blade is chosen.", icon="INFO")
            return
        settings = collection.coolinggen
        row.operator("coolinggen.save", text="Save")
        row = layout.row(align=True)
        row.prop(settings, "live", toggle=True)
        row.operator("coolinggen.update", icon="FILE_REFRESH")
        row.operator("coolinggen.export", icon="EXPORT", text="Export")
        row = layout.row(align=True)
        for look, label, _ in LOOKS:
            row.operator("coolinggen.look", text=label, depress=settings.look == look).look = look
        if settings.look == "THICKNESS":
            _legend(layout, collection)
        _state(layout, collection)


def _legend(layout, collection) -> None:
    """Which colour means which thickness."""
    settings, ramp = collection.coolinggen, thickness.ramp(collection)
    if ramp is None:
        return
    box = layout.box()
    box.label(text="Wall thickness (mm); grey: no wall")
    box.template_color_ramp(ramp, "color_ramp")
    row = box.row(align=True)
    ends = row.row(align=True)
    ends.enabled = not settings.thickness_auto
    ends.prop(settings, "thickness_low")
    ends.prop(settings, "thickness_high")
    row.prop(settings, "thickness_auto", toggle=True)


def _state(layout, collection) -> None:
    settings = collection.coolinggen
    if live.busy(collection):
        told = live.progress(collection)
        row = layout.row()
        row.progress(factor=told.fraction if told else 0.0, text=told.stage if told else "waiting")
        row.operator("coolinggen.cancel", icon="X", text="")
        return
    if settings.failure:
        box = layout.box()
        box.alert = True
        box.label(text=settings.failure, icon="ERROR")
        for fault in settings.faults:
            box.label(text=f"{fault.pointer}: {fault.message}")
            if fault.hint:
                box.label(text=fault.hint)
    elif settings.built and not blades.up_to_date(collection):
        layout.label(text="Shows an older design.", icon="INFO")
    if settings.notice:
        row = layout.row()
        row.alert = settings.notice_is_bad
        row.label(text=settings.notice, icon="ERROR" if settings.notice_is_bad else "CHECKMARK")
    if settings.fit_mm >= 0.0:
        row = layout.row()
        row.label(
            text=f"The object's {settings.fit_points} points: within {settings.fit_mm:.4f} mm",
            icon="SNAP_FACE",
        )
        row.operator("coolinggen.farthest", text="", icon="CURSOR")


class Things(bpy.types.UIList):
    """The things of a list by their names"""

    bl_idname = "COOLINGGEN_UL_things"

    def draw_item(self, _context, layout, _data, item, _icon, _active, _property, index):
        label = getattr(item, "name", "") or getattr(item, "chamber", "") or f"{index + 1}"
        layout.label(text=label)


class DesignPanel(Sidebar):
    """Fields of the design, or of its cooling."""

    bl_parent_id = "COOLINGGEN_PT_main"
    bl_options = {"DEFAULT_CLOSED"}
    path = ""
    fields: tuple[forms.Field, ...] = ()

    @classmethod
    def poll(cls, context):
        collection = blades.active(context)
        return collection is not None and (not cls.path or collection.coolinggen.design.cooling_given)

    def draw(self, context):
        design = blades.active(context).coolinggen.design
        owner = design.path_resolve(self.path) if self.path else design
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for field in self.fields:
            _draw(self.layout, owner, self.path, field, headed=False)


class CoolingPanel(DesignPanel):
    """The cooling's own fields; its parts have panels below this one."""

    bl_options = set()
    path = "cooling"

    @classmethod
    def poll(cls, context):
        return blades.active(context) is not None

    def draw_header(self, context):
        self.layout.prop(blades.active(context).coolinggen.design, "cooling_given", text="")

    def draw(self, context):
        if blades.active(context).coolinggen.design.cooling_given:
            DesignPanel.draw(self, context)


def _draw(layout, owner, path: str, field: forms.Field, headed: bool = True) -> None:
    """Draws a field of ``owner``, which is at ``path`` in the design."""
    key = field.key
    if switched(field):
        layout.prop(owner, f"{key}_given", text=field.title)
        if not getattr(owner, f"{key}_given"):
            return
    here = f"{path}.{key}" if path else key
    label = _label(field)
    match field.shape:
        case forms.Group() as group:
            box = _box(layout, field.title if headed else "")
            for part in group.fields:
                _draw(box, getattr(owner, key), here, part)
        case forms.Variants(options=options):
            box = _box(layout, "")
            box.prop(owner, f"{key}_kind", text=field.title)
            kind = getattr(owner, f"{key}_kind")
            group = next(group for each, _, group in options if each == kind)
            for part in group.fields:
                _draw(box, getattr(owner, f"{key}_{word(kind)}"), f"{here}_{word(kind)}", part)
        case forms.List():
            _draw_list(layout, owner, here, field, headed)
        case forms.Law():
            _draw_law(layout, owner, here, key, label)
        case forms.Number(words=words) if words:
            layout.prop(owner, f"{key}_word", text=field.title)
            if getattr(owner, f"{key}_word") == "number":
                layout.prop(owner, key, text=label)
        case _:
            layout.prop(owner, key, text=label)


def _draw_law(layout, owner, path: str, key: str, label: str) -> None:
    row = layout.row(align=True)
    varies = getattr(owner, f"{key}_varies")
    if not varies:
        row.prop(owner, key, text=label)
    else:
        row.label(text=label)
    row.prop(owner, f"{key}_varies", text="", icon="FCURVE", toggle=True)
    if not varies:
        return
    column = layout.column(align=True)
    column.use_property_split = False
    for k, point in enumerate(getattr(owner, f"{key}_rows")):
        row = column.row(align=True)
        row.prop(point, "v", text="")
        row.prop(point, "value", text="")
        _deed(row, f"{path}_rows", "REMOVE", "X", k)
    _deed(column, f"{path}_rows", "ADD", "ADD")


def _draw_list(layout, owner, path: str, field: forms.Field, headed: bool) -> None:
    key = field.key
    if headed:
        layout.label(text=field.title)
    row = layout.row()
    row.template_list(Things.bl_idname, path, owner, key, owner, f"{key}_index", rows=3)
    column = row.column(align=True)
    for deed, icon in (
        ("ADD", "ADD"),
        ("COPY", "DUPLICATE"),
        ("REMOVE", "REMOVE"),
        ("UP", "TRIA_UP"),
        ("DOWN", "TRIA_DOWN"),
    ):
        _deed(column, path, deed, icon)
    things, chosen = getattr(owner, key), getattr(owner, f"{key}_index")
    if not 0 <= chosen < len(things):
        return
    if isinstance(field.shape.item, forms.Text):
        layout.prop(things[chosen], "value", text="")
        return
    box = layout.box()
    for part in field.shape.item.fields:
        _draw(box, things[chosen], f"{path}[{chosen}]", part)


def _deed(layout, path: str, deed: str, icon: str, index: int = -1) -> None:
    told = layout.operator("coolinggen.edit_list", text="", icon=icon)
    told.path, told.deed, told.index = path, deed, index


def _box(layout, title: str):
    box = layout.box()
    if title:
        box.label(text=title)
    return box


def _label(field: forms.Field) -> str:
    return f"{field.title} ({field.unit})" if field.unit else field.title


class Measured(Sidebar, bpy.types.Panel):
    """What was measured"""

    bl_idname = "COOLINGGEN_PT_measured"
    bl_label = "Measured"
    bl_parent_id = "COOLINGGEN_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        collection = blades.active(context)
        return collection is not None and bool(collection.coolinggen.report)

    def draw(self, context):
        report = json.loads(blades.active(context).coolinggen.report)
        column = self.layout.column(align=True)
        for name, solid in report["solids"].items():
            _measure(column, name, f"{solid['volume_mm3']:.1f} mm³")
        if wall := report.get("wall_thickness_mm"):
            _measure(column, "thinnest wall", f"{wall['min']:.3f} mm, {wall['face']}")


def _measure(column, what: str, value: str) -> None:
    row = column.row()
    row.label(text=what)
    row.label(text=value)


class Faces(Sidebar, bpy.types.Panel):
    """What can be done with the faces by their names"""

    bl_idname = "COOLINGGEN_PT_faces"
    bl_label = "Faces by Name"
    bl_parent_id = "COOLINGGEN_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return blades.active(context) is not None

    def draw(self, _context):
        self.layout.operator("coolinggen.select_faces")
        self.layout.operator("coolinggen.vertex_groups")


def _parts() -> list[type]:
    """Panels for the fields of the design and of its cooling: one for the plain ones, one each for others."""
    made = [_panel("design", "Design", "The design's name and what it is about.", _plain(FORM))]
    for field in FORM.fields:
        if field.key == "cooling":
            cooling: forms.Group = field.shape
            top = _panel(field.key, field.title, field.description, _plain(cooling), CoolingPanel)
            made.append(top)
            made += [
                _panel(
                    f"cooling_{part.key}",
                    part.title,
                    part.description,
                    (part,),
                    path="cooling",
                    bl_parent_id=top.bl_idname,
                )
                for part in cooling.fields
                if not _is_plain(part)
            ]
        elif not _is_plain(field):
            made.append(_panel(field.key, field.title, field.description, (field,)))
    return made


def _plain(group: forms.Group) -> tuple[forms.Field, ...]:
    return tuple(field for field in group.fields if _is_plain(field))


def _is_plain(field: forms.Field) -> bool:
    return not isinstance(field.shape, forms.Group | forms.Variants | forms.List)


def _panel(
    key: str, label: str, about: str, fields: tuple[forms.Field, ...], kind=DesignPanel, **more
) -> type:
    name = f"COOLINGGEN_PT_{key}"
    return type(
        name,
        (kind, bpy.types.Panel),
        {"bl_idname": name, "bl_label": label, "__doc__": about, "fields": fields, **more},
    )


CLASSES = [Things, Main, *_parts(), Faces, Measured]

register, unregister = bpy.utils.register_classes_factory(CLASSES)
