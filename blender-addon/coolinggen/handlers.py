"""What is done when Blender undoes, redoes or opens a file."""

import bpy
from bpy.app.handlers import persistent

from . import blades, live


@persistent
def _moved_in_time(_scene, *_rest) -> None:
    """After undo and redo a blade may show another design than its properties say."""
    live.moved()
    for collection in blades.blades():
        if collection.coolinggen.live and not blades.up_to_date(collection):
            live.touch(collection)


@persistent
def _opening(*_rest) -> None:
    """What is being built belongs to a file that goes."""
    live.stop()
    live.moved()


def register() -> None:
    """Begins to listen."""
    bpy.app.handlers.undo_post.append(_moved_in_time)
    bpy.app.handlers.redo_post.append(_moved_in_time)
    bpy.app.handlers.load_pre.append(_opening)


def unregister() -> None:
    """Ends listening."""
    bpy.app.handlers.undo_post.remove(_moved_in_time)
    bpy.app.handlers.redo_post.remove(_moved_in_time)
    bpy.app.handlers.load_pre.remove(_opening)
