"""Blades in a scene: a collection a design, an object a solid."""

import hashlib
import json

import bpy

from . import live, looks, values
from .building import Built, Order
from .meshes import Arrays, fill
from .schema import FORM

#: The object's property with the name of its solid.
SOLID = "coolinggen_solid"
#: The mesh's property with the layer of each of its material slots, JSON.
LAYERS = "coolinggen_layers"

#: By collection what :func:`up_to_date` last said, and when: it is asked at each redraw.
_known: dict[int, tuple[object, bool]] = {}


def blades() -> list:
    """The collections that are blades."""
    return [collection for collection in bpy.data.collections if collection.coolinggen.is_blade]


def active(context):
    """The blade that the panel is about: the chosen collection's, the chosen object's, or the only one."""
    chosen = [context.collection, *(context.object.users_collection if context.object else ())]
    for collection in chosen:
        if collection is not None and collection.coolinggen.is_blade:
            return collection
    found = blades()
    return found[0] if len(found) == 1 else None


def new(scene, design: dict, folder: str = ""):
    """A blade of this design in ``scene``, not built yet. Relative paths in it begin in ``folder``."""
    collection = bpy.data.collections.new(design.get("name") or "blade")
    scene.collection.children.link(collection)
    with live.quiet():
        collection.coolinggen.is_blade = True
        collection.coolinggen.folder = folder
    set_design(collection, design)
    return collection


def design(collection) -> dict:
    """The design of a blade as its properties say."""
    settings = collection.coolinggen
    return values.read(settings.design, FORM, json.loads(settings.source or "{}"))


def set_design(collection, design: dict) -> None:
    """Sets a blade's properties as ``design`` says; it does not follow by itself."""
    settings = collection.coolinggen
    with live.quiet():
        values.write(settings.design, FORM, design)
        settings.source = json.dumps(design)
    live.moved()


def order(collection) -> Order:
    """What is to be built for a blade to follow its design."""
    settings = collection.coolinggen
    folder = bpy.path.abspath(settings.folder) if settings.folder else ""
    model = f"blender-{collection.session_uid}"
    thickness = settings.look == "THICKNESS"
    return Order(model, design(collection), folder, settings.chord_mm, settings.angle_deg, thickness)


def mark(order: Order) -> str:
    """What tells an order from others."""
    told = json.dumps([order.design, order.folder, order.chord_mm, order.angle_deg])
    return hashlib.sha256(told.encode()).hexdigest()


def up_to_date(collection) -> bool:
    """Whether a blade shows its design."""
    settings = collection.coolinggen
    known = live.changes(), settings.built
    if _known.get(collection.session_uid, (None, None))[0] != known:
        _known[collection.session_uid] = known, settings.built == mark(order(collection))
    return _known[collection.session_uid][1]


def show(collection, solid: Arrays) -> None:
    """Shows a solid: by the object that has shown it before, with its materials and modifiers, or anew."""
    found = objects(collection).get(solid.name)
    if found is None:
        name = f"{collection.name} {solid.name}"
        found = bpy.data.objects.new(name, bpy.data.meshes.new(name))
        found[SOLID] = solid.name
        collection.objects.link(found)
    mesh, groups = found.data, [group.name for group in found.vertex_groups]
    fill(mesh, solid, units_a_millimetre(), _slots(mesh, solid))
    # They went with the old vertices, but what refers to them should still find them.
    for name in groups:
        if name not in found.vertex_groups:
            found.vertex_groups.new(name=name)


def finish(collection, built: Built) -> None:
    """Takes away what the design has no more, and keeps what was measured."""
    names = {solid.name for solid in built.solids}
    for name, found in objects(collection).items():
        if name not in names:
            mesh = found.data
            bpy.data.objects.remove(found)
            if mesh.users == 0:
                bpy.data.meshes.remove(mesh)
    settings = collection.coolinggen
    settings.report = built.report
    settings.built = mark(built.order)
    settings.failure = ""
    settings.faults.clear()


def fail(collection, message: str, faults: list[dict]) -> None:
    """Keeps why a blade does not follow its design."""
    settings = collection.coolinggen
    settings.failure = message
    settings.faults.clear()
    for fault in faults:
        told = settings.faults.add()
        told.pointer, told.message, told.hint = fault["pointer"], fault["message"], fault.get("hint") or ""


def tell(collection, notice: str, bad: bool) -> None:
    """Keeps what came of something done with a blade, for the panel."""
    settings = collection.coolinggen
    settings.notice, settings.notice_is_bad = notice, bad


def objects(collection) -> dict[str, object]:
    """The objects of a blade by the names of their solids."""
    return {found[SOLID]: found for found in collection.objects if SOLID in found and found.type == "MESH"}


def units_a_millimetre() -> float:
    """Blender units a millimetre in the scene shown."""
    return 1e-3 / bpy.context.scene.unit_settings.scale_length


def layers(mesh) -> list[str]:
    """The layer of each material slot of a solid's mesh."""
    return json.loads(mesh.get(LAYERS, "[]"))


def _slots(mesh, solid: Arrays) -> list[int]:
    """The material slot of each layer. A slot stays its layer's, whatever material the user has put there."""
    known = layers(mesh)
    slots = []
    for layer, color in solid.layers:
        if layer not in known:
            known.append(layer)
        slot = known.index(layer)
        if slot >= len(mesh.materials):
            mesh.materials.append(looks.material(solid.name, layer, color))
        slots.append(slot)
    mesh[LAYERS] = json.dumps(known)
    return slots
