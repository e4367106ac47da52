"""Blades follow their designs: what changes is built beside the window and shown piece by piece.

The window's thread only ever fills one mesh at a time.
"""

import contextlib
import time
from collections.abc import Callable, Iterable
from functools import partial

import bpy

from . import beside, service
from .client.latest import Done, Progress
from .client.sidecar import CancelledError, RefusedError

#: A change is built when nothing more has changed for so long, s.
PATIENCE = 0.15
#: How often the news are fetched, s.
INTERVAL = 0.02

_quiet = 0
_changes = 0
_due: dict[int, float] = {}


@contextlib.contextmanager
def quiet():
    """Within it, properties may be set without their blades following."""
    global _quiet
    _quiet += 1
    try:
        yield
    finally:
        _quiet -= 1


def is_quiet() -> bool:
    """Whether properties are being set by the add-on itself."""
    return _quiet > 0


def changed(properties, _context) -> None:
    """Told by every property of a design that it has changed."""
    moved()
    if not _quiet and properties.id_data.coolinggen.live:
        touch(properties.id_data)


def moved() -> None:
    """Whatever is known of designs may be so no more."""
    global _changes
    _changes += 1


def changes() -> int:
    """A number that is another whenever a design may have changed."""
    return _changes


def touch(collection, patience: float = PATIENCE) -> None:
    """The blade in ``collection`` is to follow its design after ``patience`` s without another change."""
    _due[collection.session_uid] = time.monotonic() + patience
    watch()


def watch() -> None:
    """Has what goes on beside the window heard of, where there is a window."""
    if not bpy.app.background and not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, persistent=True)


def update(collection) -> None:
    """Builds a blade and shows it before it returns."""
    _start(collection)
    beside.wait(_key(collection.session_uid))


def busy(collection) -> bool:
    """Whether a blade is on its way to its design."""
    return collection.session_uid in _due or beside.working(_key(collection.session_uid))


def any_busy() -> bool:
    """Whether any blade is, or anything else is done beside the window."""
    return bool(_due) or beside.busy()


def progress(collection) -> Progress | None:
    """How far a blade's building is."""
    return beside.progress(_key(collection.session_uid))


def cancel() -> None:
    """Gives up all that is on its way; the blades stay as they are shown."""
    _due.clear()
    beside.cancel()


def stop() -> None:
    """Ends everything that was begun."""
    _due.clear()
    beside.stop()
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)


def reason(error: Exception) -> str:
    """Why something was not done, with all that is wrong with the design."""
    faults = error.faults if isinstance(error, RefusedError) else []
    return "; ".join([str(error), *(f"{fault['pointer']}: {fault['message']}" for fault in faults)])


def by_uid(uid: int):
    """The collection of this session's number, which may be gone."""
    return next((each for each in bpy.data.collections if each.session_uid == uid), None)


def _key(uid: int) -> tuple:
    return uid, "build"


def _tick() -> float | None:
    """What the window's thread does at each interval, short enough not to be felt."""
    now = time.monotonic()
    due = [uid for uid, when in _due.items() if when <= now]
    for uid in due:
        collection = by_uid(uid)
        if collection is None:
            del _due[uid]
        else:
            _start(collection)
    if beside.turn() or due:
        _redraw()
    if not any_busy():
        return None
    _listen()
    return INTERVAL


def _start(collection) -> None:
    # What knows of Blender's data is asked here, not in the worker's thread.
    from . import blades, building

    uid = collection.session_uid
    _due.pop(uid, None)
    order, preferred = blades.order(collection), service.preferred()
    beside.start(
        _key(uid),
        lambda watch: building.build(order, lambda: service.sidecar(preferred), watch),
        partial(_ended, uid),
    )


def _ended(uid: int, done: Done) -> Iterable[beside.Step]:
    from . import blades, groups, views

    if done.error is None:
        for solid in done.result.solids:
            yield with_blade(uid, lambda collection, solid=solid: blades.show(collection, solid))
            yield with_blade(uid, lambda collection, name=solid.name: groups.again(collection, name))
        yield with_blade(uid, lambda collection: blades.finish(collection, done.result))
        yield with_blade(uid, views.again)
    elif not isinstance(done.error, CancelledError):
        faults = done.error.faults if isinstance(done.error, RefusedError) else []
        yield with_blade(uid, lambda collection: blades.fail(collection, str(done.error), faults))


def with_blade(uid: int, step: Callable) -> beside.Step:
    """``step`` with the blade's collection, quietly; nothing if that is gone."""

    def do() -> None:
        collection = by_uid(uid)
        if collection is not None:
            with quiet():
                step(collection)

    return do


def _listen() -> None:
    """Has ESC heard in the first window."""
    from .operators.building import Escape

    window = next(iter(bpy.context.window_manager.windows), None)
    if window is not None and not Escape.listening:
        with bpy.context.temp_override(window=window):
            bpy.ops.coolinggen.escape("INVOKE_DEFAULT")


def _redraw() -> None:
    """Has the panel say how far things are; what is drawn of the blade itself Blender sees to."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            for region in area.regions:
                if area.type == "VIEW_3D" and region.type == "UI":
                    region.tag_redraw()
