"""What can be done: one file a kind of deed."""

import bpy

from . import building, designs, drawn, faces, files, groups, lists, views

CLASSES = [
    each
    for module in (designs, drawn, building, files, lists, faces, groups, views)
    for each in module.CLASSES
]

register, unregister = bpy.utils.register_classes_factory(CLASSES)
