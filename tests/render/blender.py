"""The pictures of docs/blender.md, made by the extension itself in Blender's module, with Cycles.

tests/install && cd tests && .venv-bpy4.5/bin/python render/blender.py [FOLDER]
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "blender"))

# The first says where Blender's settings are before Blender is there.
import conftest  # noqa: E402, I001
import bpy  # noqa: E402

#: Picture, template, look.
PICTURES = [
    ("whole", "rotor-serpentine", "WHOLE"),
    ("cut", "rotor-serpentine", "CUT"),
    ("glass", "rotor-serpentine", "GLASS"),
    ("coolant", "rotor-serpentine", "COOLANT"),
]


def picture(path: Path, template: str, look: str) -> None:
    """Renders a template as it looks."""
    bpy.ops.wm.read_homefile(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 640, 640
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 32, True
    scene.view_settings.view_transform = "Standard"
    world = bpy.data.worlds.new("sky")
    scene.world = world
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.75, 0.8, 0.88, 1.0)
    bpy.ops.coolinggen.new(template=template)
    bpy.ops.coolinggen.turntable(frames=12)
    bpy.ops.coolinggen.look(look=look)
    scene.frame_set(1)
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)


def main() -> None:
    """Makes all pictures."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "gallery" / "blender"
    conftest.install()
    importlib.import_module(conftest.MODULE)
    for name, template, look in PICTURES:
        picture(folder / f"{name}.png", template, look)


if __name__ == "__main__":
    main()
