"""Blades follow their designs: what changes is built beside the window and shown piece by piece.

The window's thread only ever fills one mesh at a time; all else is done in a thread of the blade's own.
"""

import contextlib
import itertools
import time
from collections import deque
from collections.abc import Callable

import bpy

from . import service
from .client.latest import Done, Latest, Progress
from .client.sidecar import CancelledError, RefusedError

#: A change is built when nothing more has changed for so long, s.
PATIENCE = 0.15
#: How often the news are fetched, s.
INTERVAL = 0.02

_quiet = 0
_due: dict[int, float] = {}
_builders: dict[int, Latest] = {}
_steps: deque[tuple[int, Callable]] = deque()
#: The number of the order that a blade waits for.
_awaited: dict[int, int] = {}
_orders = itertools.count()
_progress: dict[int, Progress] = {}


@contextlib.contextmanager
def quiet():
    """Within it, properties may be set without their blades following."""
    global _quiet
    _quiet += 1
    try:
        yield
    finally:
        _quiet -= 1


def changed(properties, _context) -> None:
    """Told by every property of a design that it has changed."""
    if not _quiet and properties.id_data.coolinggen.live:
        touch(properties.id_data)


def touch(collection, patience: float = PATIENCE) -> None:
    """The blade in ``collection`` is to follow its design after ``patience`` s without another change."""
    _due[collection.session_uid] = time.monotonic() + patience
    if not bpy.app.background and not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, persistent=True)


def update(collection) -> None:
    """Builds a blade and shows it before it returns."""
    _start(collection)
    while _working(collection.session_uid):
        _hear()
        _step()
        time.sleep(0.001)


def busy(collection) -> bool:
    """Whether a blade is on its way to its design."""
    return collection.session_uid in _due or _working(collection.session_uid)


def any_busy() -> bool:
    """Whether any blade is."""
    return bool(_due or _awaited or _steps)


def progress(collection) -> Progress | None:
    """How far a blade's building is."""
    return _progress.get(collection.session_uid)


def cancel() -> None:
    """Gives up all that is on its way; the blades stay as they are shown."""
    _due.clear()
    _awaited.clear()
    for builder in _builders.values():
        builder.cancel()


def stop() -> None:
    """Ends everything that was begun."""
    cancel()
    _steps.clear()
    _progress.clear()
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    for builder in _builders.values():
        builder.close()
    _builders.clear()


def _tick() -> float | None:
    """What the window's thread does at each interval, short enough not to be felt."""
    now = time.monotonic()
    for uid in [uid for uid, when in _due.items() if when <= now]:
        collection = _collection(uid)
        if collection is None:
            del _due[uid]
        else:
            _start(collection)
    _hear()
    _step()
    _redraw()
    if not any_busy():
        return None
    _listen()
    return INTERVAL


def _start(collection) -> None:
    # What knows of Blender's data is asked here, not in the builder's thread.
    from . import blades, building

    uid = collection.session_uid
    _due.pop(uid, None)
    order, preferred = blades.order(collection), service.preferred()
    builder = _builders.setdefault(uid, Latest())
    number = _awaited[uid] = next(_orders)
    builder.submit(lambda watch: building.build(order, lambda: service.sidecar(preferred), watch), number)


def _working(uid: int) -> bool:
    return uid in _awaited or any(uid == other for other, _ in _steps)


def _hear() -> None:
    from . import blades

    for uid, builder in _builders.items():
        for news in builder.news():
            if isinstance(news, Progress):
                _progress[uid] = news
            elif news.tag == _awaited.get(uid):
                del _awaited[uid]
                _progress.pop(uid, None)
                _ended(uid, news, blades)


def _ended(uid: int, done: Done, blades) -> None:
    if done.error is None:
        built = done.result
        for solid in built.solids:
            _steps.append((uid, lambda collection, solid=solid: blades.show(collection, solid)))
        _steps.append((uid, lambda collection: blades.finish(collection, built)))
    elif isinstance(done.error, CancelledError):
        pass
    elif done.error is not None:
        faults = done.error.faults if isinstance(done.error, RefusedError) else []
        _steps.append((uid, lambda collection: blades.fail(collection, str(done.error), faults)))


def _step() -> None:
    if _steps:
        uid, step = _steps.popleft()
        collection = _collection(uid)
        if collection is not None:
            with quiet():
                step(collection)


def _collection(uid: int):
    return next((each for each in bpy.data.collections if each.session_uid == uid), None)


def _listen() -> None:
    """Has ESC heard in the first window."""
    from .operators.building import Escape

    window = next(iter(bpy.context.window_manager.windows), None)
    if window is not None and not Escape.listening:
        with bpy.context.temp_override(window=window):
            bpy.ops.coolinggen.escape("INVOKE_DEFAULT")


def _redraw() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
