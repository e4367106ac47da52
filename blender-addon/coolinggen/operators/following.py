"""What operators do while something goes on beside the window: nothing where there is a window, else wait."""

import bpy

from .. import beside, live


def follow(operator, collection) -> set[str]:
    """Builds a blade: beside the window where there is one, else before it returns."""
    if not bpy.app.background:
        live.touch(collection, 0.0)
        return {"FINISHED"}
    live.update(collection)
    return _told(operator, collection.coolinggen.failure)


def ended(operator, collection, key) -> set[str]:
    """What an operator returns that has started a job of ``key``; the blade's notice says how it ended."""
    if not bpy.app.background:
        live.watch()
        return {"FINISHED"}
    beside.wait(key)
    settings = collection.coolinggen
    return _told(operator, settings.notice if settings.notice_is_bad else "")


def _told(operator, failure: str) -> set[str]:
    if not failure:
        return {"FINISHED"}
    operator.report({"ERROR"}, failure)
    return {"CANCELLED"}
