"""What can be done: one file a kind of deed."""

import bpy

from . import building, designs, faces, files, lists, views

CLASSES = [each for module in (designs, building, files, lists, faces, views) for each in module.CLASSES]

register, unregister = bpy.utils.register_classes_factory(CLASSES)
