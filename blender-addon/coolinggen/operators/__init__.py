"""What can be done: one file a kind of deed."""

import bpy

from . import building, designs, faces, files, lists, views

CLASSES = [each for module in (designs, building, files, lists, faces, views) for each in module.CLASSES]


def register() -> None:
    """Makes the operators known."""
    for kind in CLASSES:
        bpy.utils.register_class(kind)


def unregister() -> None:
    """Takes them away."""
    for kind in reversed(CLASSES):
        bpy.utils.unregister_class(kind)
