"""An object of the scene as the blade."""

from functools import partial

import bpy

from .. import beside, blades, building, drawn, live, service
from ..client.latest import Done
from .designs import begin
from .following import ended


class FromObject(bpy.types.Operator):
    """Cools the active object in its place: a loft of quads or other mesh, closed curves, a NURBS surface"""

    bl_idname = "coolinggen.from_object"
    bl_label = "Cool the Active Object"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        chosen = context.object
        return chosen is not None and context.mode == "OBJECT" and blades.SOLID not in chosen

    def execute(self, context):
        chosen = context.object
        try:
            found = drawn.design(context, chosen)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        outcome = begin(self, context, found.design, "")
        collection = blades.active(context)
        if "FINISHED" not in outcome:
            return outcome
        chosen.hide_set(True)
        return _compare(self, collection, drawn.reached(found.design["space"], found.points))


def _compare(operator, collection, points) -> set[str]:
    order, preferred = blades.order(collection), service.preferred()
    key = collection.session_uid, "distance"
    beside.start(
        key,
        lambda watch: building.distance(order, points, lambda: service.sidecar(preferred), watch),
        partial(_compared, collection.session_uid, len(points)),
    )
    return ended(operator, collection, key)


def _compared(uid: int, count: int, done: Done):
    def tell(collection) -> None:
        settings = collection.coolinggen
        if done.error is not None:
            blades.tell(collection, f"Not compared with the object: {live.reason(done.error)}", bad=True)
            return
        distance, where = done.result
        settings.fit_mm, settings.fit_points = distance, count
        settings.fit_at = blades.units_a_millimetre() * where

    yield live.with_blade(uid, tell)


class Farthest(bpy.types.Operator):
    """Puts the 3D cursor where the object is farthest from the blade"""

    bl_idname = "coolinggen.farthest"
    bl_label = "Show the Farthest Point"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        collection = blades.active(context)
        return collection is not None and collection.coolinggen.fit_mm >= 0.0

    def execute(self, context):
        context.scene.cursor.location = blades.active(context).coolinggen.fit_at
        return {"FINISHED"}


CLASSES = [FromObject, Farthest]
