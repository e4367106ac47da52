"""The sidebar: everything that a design can say is drawn, for whatever else it says."""

from __future__ import annotations

import importlib
from types import SimpleNamespace

import bpy
import pytest

from conftest import MODULE


def part(name: str):
    return importlib.import_module(f"{MODULE}.{name}")


class Recorder:
    """A layout that notes the properties that are drawn, by their owners' classes."""

    def __init__(self, drawn: set | None = None, told: list | None = None):
        self.drawn: set[tuple[str, str]] = set() if drawn is None else drawn
        self.told: list[str] = [] if told is None else told

    def prop(self, owner, name: str, **_how):
        assert name in owner.bl_rna.properties, name
        self.drawn.add((type(owner).__name__, name))

    def template_list(self, _kind, _id, owner, things, _active_owner, active, **_how):
        self.drawn |= {(type(owner).__name__, things), (type(owner).__name__, active)}

    def label(self, text: str = "", **_how):
        self.told.append(text)

    def operator(self, _name: str, **_how):
        return SimpleNamespace()

    def __getattr__(self, name: str):
        if name in ("row", "column", "box", "split"):
            return lambda **_how: Recorder(self.drawn, self.told)
        return lambda *_what, **_how: None


def draw(layout: Recorder) -> None:
    """Draws all panels that would be."""
    for kind in part("panels").CLASSES:
        if issubclass(kind, bpy.types.Panel) and (not hasattr(kind, "poll") or kind.poll(bpy.context)):
            # Blender makes panels itself: here their methods draw for something that only has a layout.
            panel = SimpleNamespace(
                layout=layout, fields=getattr(kind, "fields", ()), path=getattr(kind, "path", "")
            )
            if hasattr(kind, "draw_header"):
                kind.draw_header(panel, bpy.context)
            kind.draw(panel, bpy.context)


def fill(owner, group, turn: int) -> int:
    """Gives every list of ``owner`` a thing, every switched field a value, and of each choice of fields the
    one whose ``turn`` it is; how many turns it takes for all of them."""
    forms, properties = part("client.forms"), part("properties")
    turns = 1
    for field in group.fields:
        key = field.key
        if properties.switched(field):
            setattr(owner, f"{key}_given", True)
        match field.shape:
            case forms.Group() as inner:
                turns = max(turns, fill(getattr(owner, key), inner, turn))
            case forms.Variants(options=options):
                kind, _, inner = options[turn % len(options)]
                setattr(owner, f"{key}_kind", kind)
                within = fill(getattr(owner, f"{key}_{properties.word(kind)}"), inner, turn // len(options))
                turns = max(turns, len(options) * max(within, 4))
            case forms.List(item=item):
                things = getattr(owner, key)
                if not things:
                    things.add()
                setattr(owner, f"{key}_index", 0)
                if isinstance(item, forms.Group):
                    turns = max(turns, fill(things[0], item, turn))
            case forms.Law():
                setattr(owner, f"{key}_varies", bool(turn % 2))
                if turn % 2 and not getattr(owner, f"{key}_rows"):
                    getattr(owner, f"{key}_rows").add()
                turns = max(turns, 2)
            case forms.Number(words=words) if words:
                setattr(owner, f"{key}_word", "number")
    return turns


def test_every_field_can_be_reached(rotor):
    form, live = part("schema").FORM, part("live")
    design = rotor.coolinggen.design
    layout, turn, turns = Recorder(), 0, 1
    with live.quiet():
        while turn < turns:
            turns = max(turns, fill(design, form, turn))
            draw(layout)
            turn += 1
    wanted = {
        (kind.__name__, name)
        for kind in part("settings")._DESIGN
        for name in kind.__annotations__
        # Pointers to groups are drawn by what is in them, rows by theirs.
        if kind.bl_rna.properties[name].type != "POINTER" and not name.endswith("_rows")
    }
    assert len(wanted) > 200
    assert not wanted - layout.drawn


def test_without_cooling_its_parts_are_not_drawn(rotor):
    rotor.coolinggen.design.cooling_given = False
    layout = Recorder()
    draw(layout)
    names = {name for _, name in layout.drawn}
    assert {"cooling_given", "name", "description"} <= names and "chambers" not in names
    assert bpy.ops.coolinggen.update() == {"FINISHED"}
    assert set(part("blades").objects(rotor)) == {"metal"}


def test_faults_and_older_designs_are_told(rotor):
    layout = Recorder()
    rotor.coolinggen.live = False
    rotor.coolinggen.design.cooling.chambers[0].fillet_radius = 500.0
    draw(layout)
    assert any("older design" in text for text in layout.told)
    with pytest.raises(RuntimeError):
        bpy.ops.coolinggen.update()
    layout = Recorder()
    draw(layout)
    assert any(text.startswith("/cooling/chambers/0/") for text in layout.told)


def test_whether_a_blade_is_up_to_date_is_not_asked_at_each_redraw(rotor, monkeypatch):
    blades, asked = part("blades"), []
    true = blades.design
    monkeypatch.setattr(blades, "design", lambda collection: asked.append(1) or true(collection))
    for _ in range(5):
        assert blades.up_to_date(rotor)
    assert len(asked) <= 1
    rotor.coolinggen.design.cooling.chambers[0].fillet_radius *= 1.01
    assert not blades.up_to_date(rotor) and not blades.up_to_date(rotor)
    assert len(asked) <= 2
    part("live").cancel()


LISTS = ["chambers", "walls", "turns", "inserts", "radial_holes", "film_rows", "slot_rows", "crossover_rows"]


@pytest.mark.parametrize("name", [*LISTS, "pin_arrays", "dust_holes"])
def test_things_of_every_list_come_and_go(rotor, name):
    blades, forms = part("blades"), part("client.forms")
    before = blades.design(rotor)
    things = getattr(rotor.coolinggen.design.cooling, name)
    count, path = len(things), f"cooling.{name}"
    assert bpy.ops.coolinggen.edit_list(path=path, deed="ADD") == {"FINISHED"}
    assert bpy.ops.coolinggen.edit_list(path=path, deed="COPY") == {"FINISHED"}
    assert len(things) == count + 2
    listed = blades.design(rotor)["cooling"][name]
    shape = next(
        field.shape.item
        for cooling in part("schema").FORM.fields
        if cooling.key == "cooling"
        for field in cooling.shape.fields
        if field.key == name
    )
    required = {field.key for field in shape.fields if field.required}
    assert isinstance(shape, forms.Group) and required <= set(listed[-1])
    if "name" in required:
        assert len({each["name"] for each in listed}) == count + 2
    assert bpy.ops.coolinggen.edit_list(path=path, deed="UP") == {"FINISHED"}
    moved = blades.design(rotor)["cooling"][name]
    assert moved[-1] == listed[-2] and moved[-2] == listed[-1]
    assert bpy.ops.coolinggen.edit_list(path=path, deed="DOWN") == {"FINISHED"}
    for _ in range(2):
        assert bpy.ops.coolinggen.edit_list(path=path, deed="REMOVE") == {"FINISHED"}
    assert blades.design(rotor) == before
    assert part("live").busy(rotor)
    part("live").cancel()


def test_rows_of_a_law_come_and_go(rotor):
    shell = rotor.coolinggen.design.cooling.shell
    shell.pressure_side_varies = True
    shell.pressure_side_rows.clear()
    for k in range(3):
        path = "cooling.shell.pressure_side_rows"
        assert bpy.ops.coolinggen.edit_list(path=path, deed="ADD") == {"FINISHED"}
        shell.pressure_side_rows[k].v, shell.pressure_side_rows[k].value = k / 2, 1.0 + k / 10
    bpy.ops.coolinggen.edit_list(path=path, deed="REMOVE", index=1)
    said = part("blades").design(rotor)["cooling"]["shell"]["pressure_side"]
    assert said == [[0.0, 1.0], [1.0, 1.2]]
    part("live").cancel()
