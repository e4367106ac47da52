"""Played inside a Blender with a window: ``tests/blender/in_window`` starts it. Writes what it saw as JSON.

blender --factory-startup --enable-event-simulate --python window.py -- EXTENSION.zip FOLDER
"""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
import time
import traceback
from pathlib import Path

import bpy

EXTENSION, FOLDER = sys.argv[sys.argv.index("--") + 1 :]
MODULE = "bl_ext.user_default.coolinggen"
FOLDER = Path(FOLDER)
seen: dict[str, object] = {"version": bpy.app.version_string, "work_ms": 0.0, "turns": {}}


class Turns:
    """Watches how long Blender takes from one return to its timers to the next: all that a user feels.

    Events, drawing, what depends on what, and the add-on's own steps lie between. The processor's time is
    what a machine that is busy with other things, drawing among them, does not make longer.
    """

    def __init__(self):
        self.phase, self._last = "", None
        self.ours = 0.0  #: The processor's time for the add-on in this turn, s.
        bpy.app.timers.register(self._beat)

    def _beat(self) -> float:
        now = time.perf_counter(), time.thread_time()
        if self._last is not None and self.phase:
            whole, cpu = (1e3 * (b - a) for a, b in zip(self._last, now, strict=True))
            turn = {"ms": whole, "cpu_ms": cpu, "ours_ms": 1e3 * self.ours}
            seen["turns"].setdefault(self.phase, []).append(turn)
        self._last, self.ours = now, 0.0
        return 0.0


turns = Turns()


def part(name: str):
    return importlib.import_module(f"{MODULE}.{name}")


def wait(until, patience: float = 120.0):
    """Lets Blender go on until something is so."""
    end = time.monotonic() + patience
    while not until():
        if time.monotonic() > end:
            raise TimeoutError
        yield 0.02


def screenshot(name: str) -> None:
    # Of the display: what Blender reads back of a window drawn in software is black.
    subprocess.run(["import", "-window", "root", str(FOLDER / f"{name}.png")], check=True)


def story():
    """What is done, a step at each return to Blender."""
    window = bpy.context.window_manager.windows[0]
    bpy.ops.extensions.package_install_files(filepath=EXTENSION, repo="user_default", enable_on_install=True)
    live, blades = part("live"), part("blades")
    ticked = live._tick

    def measured():
        worked = time.thread_time()
        try:
            return ticked()
        finally:
            worked = time.thread_time() - worked
            turns.ours += worked
            seen["work_ms"] = max(seen["work_ms"], 1e3 * worked)

    live._tick = measured
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    (view,) = [area for area in window.screen.areas if area.type == "VIEW_3D"]
    view.spaces.active.show_region_ui = True
    yield 0.5
    sidebar = next(region for region in view.regions if region.type == "UI")
    if hasattr(sidebar, "active_panel_category"):
        try:
            sidebar.active_panel_category = "CoolingGen"
        except (AttributeError, TypeError):
            seen["category"] = "cannot be chosen by a script in this Blender"
    with bpy.context.temp_override(window=window, area=view):
        bpy.ops.coolinggen.new(template="rotor-serpentine")
    collection = bpy.data.collections["rotor-serpentine"]
    seen["busy_at_once"] = live.busy(collection)
    yield from wait(lambda: not live.busy(collection))
    seen["failure"] = collection.coolinggen.failure
    seen["solids"] = sorted(blades.objects(collection))
    space = view.spaces.active
    space.clip_start = 1e-3
    main = next(region for region in view.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=view, region=main):
        bpy.ops.view3d.view_all()
    space.shading.color_type = "MATERIAL"
    space.overlay.show_floor = space.overlay.show_axis_x = space.overlay.show_axis_y = False
    yield 1.0
    screenshot("built")
    # What the window takes to be drawn when nothing is new.
    yield 1.0
    turns.phase = "still"
    for _ in range(10):
        for area in window.screen.areas:
            area.tag_redraw()
        yield 0.05
    # A slider is moved, step by step, as by a hand.
    turns.phase = "slider"
    row = collection.coolinggen.design.cooling.film_rows[0]
    for step in range(10):
        row.hole.diameter = 0.6 + 0.01 * step
        yield 0.05
    yield from wait(lambda: not live.busy(collection))
    yield 0.3
    # Letting go of a slider keeps the step.
    turns.phase = "undo"
    with bpy.context.temp_override(window=window, area=view, region=main):
        bpy.ops.ed.undo_push(message="slider")
    yield 0.1
    turns.phase = ""
    seen["followed"] = blades.up_to_date(collection)
    # Files are written beside the window, too.
    begin = time.perf_counter()
    with bpy.context.temp_override(window=window, area=view):
        bpy.ops.coolinggen.export(directory=str(FOLDER / "out"), formats={"stl"})
    seen["export_kept_the_window_ms"] = 1e3 * (time.perf_counter() - begin)
    yield from wait(lambda: not live.any_busy())
    seen["exported"] = collection.coolinggen.notice
    # Something slower is asked for, and ESC pressed while it is built.
    shown = collection.coolinggen.built
    collection.coolinggen.chord_mm = 0.002
    yield from wait(lambda: live.progress(collection) is not None)
    window.event_simulate("ESC", "PRESS", x=window.width // 2, y=window.height // 2)
    yield 0.05
    window.event_simulate("ESC", "RELEASE", x=window.width // 2, y=window.height // 2)
    yield from wait(lambda: not live.any_busy(), 5.0)
    yield 0.5
    seen["stopped_by_escape"] = collection.coolinggen.built == shown and not blades.up_to_date(collection)
    with bpy.context.temp_override(window=window, area=view):
        bpy.ops.coolinggen.look(look="COOLANT")
    yield 1.0
    screenshot("coolant")
    collection.coolinggen.chord_mm = 0.05
    with bpy.context.temp_override(window=window, area=view):
        bpy.ops.coolinggen.look(look="THICKNESS")
    yield from wait(lambda: not live.busy(collection))
    seen["coloured"] = part("thickness").measured(collection)
    yield 1.0
    screenshot("thickness")


def play() -> float | None:
    try:
        return next(steps)
    except StopIteration:
        seen["done"] = True
    except Exception:
        seen["error"] = traceback.format_exc()
    (FOLDER / "seen.json").write_text(json.dumps(seen))
    bpy.ops.wm.quit_blender()
    return None


bpy.context.preferences.view.show_splash = False
steps = story()
bpy.app.timers.register(play, first_interval=1.0)
