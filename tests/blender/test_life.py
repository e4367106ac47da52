"""The extension's life: registered and not, files saved and opened, undo, and a sidecar that is not well."""

from __future__ import annotations

import importlib
import json
import signal
import stat
import sys
import time

import bpy
import pytest

from conftest import MODULE


def part(name: str):
    return importlib.import_module(f"{MODULE}.{name}")


def test_nothing_is_left_when_it_is_disabled():
    def known() -> set[str]:
        return {name for name in dir(bpy.types) if "COOLINGGEN" in name.upper()}

    assert known() and hasattr(bpy.types.Collection, "coolinggen")
    timers = part("live")._tick
    for _ in range(2):
        bpy.ops.preferences.addon_disable(module=MODULE)
        assert not known() and not hasattr(bpy.types.Collection, "coolinggen")
        assert not bpy.app.timers.is_registered(timers) and not dir(bpy.ops.coolinggen)
        for listed in ("undo_post", "redo_post", "load_pre"):
            left = [getattr(each, "__module__", "") for each in getattr(bpy.app.handlers, listed)]
            assert not [name for name in left if name.startswith(MODULE)], listed
        bpy.ops.preferences.addon_enable(module=MODULE)
    assert known()


def test_a_file_opens_without_the_sidecar_and_updates_with_it(rotor, tmp_path):
    path = str(tmp_path / "saved.blend")
    faces = len(part("blades").objects(rotor)["metal"].data.polygons)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    part("service").stop()
    bpy.ops.wm.read_homefile(use_empty=True)
    preferences = bpy.context.preferences.addons[MODULE].preferences
    preferences.binary = str(tmp_path / "nowhere")
    bpy.ops.wm.open_mainfile(filepath=path)
    again = bpy.data.collections["rotor"]
    assert len(part("blades").objects(again)["metal"].data.polygons) == faces
    assert part("blades").up_to_date(again)
    with pytest.raises(RuntimeError, match="nowhere"):
        bpy.ops.coolinggen.update()
    assert "nowhere" in again.coolinggen.failure
    preferences.binary = ""
    assert bpy.ops.coolinggen.update() == {"FINISHED"} and not again.coolinggen.failure


def test_undo_and_redo(rotor):
    blades, live = part("blades"), part("live")
    shell = rotor.coolinggen.design.cooling.shell
    shell.tip_given = True
    bpy.ops.coolinggen.update()
    bpy.ops.ed.undo_push(message="before")
    before = blades.design(rotor)
    shell.tip = 2.5
    bpy.ops.coolinggen.update()
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    rotor = bpy.data.collections["rotor"]
    assert blades.design(rotor) == before and blades.up_to_date(rotor) and not live.busy(rotor)
    bpy.ops.ed.redo()
    rotor = bpy.data.collections["rotor"]
    assert blades.design(rotor)["cooling"]["shell"]["tip"] == 2.5 and blades.up_to_date(rotor)


def test_a_blade_that_undo_left_behind_follows(rotor):
    """The mesh comes after the change that caused it: what undo brings back may be older than its design."""
    blades, live = part("blades"), part("live")
    rotor.coolinggen.design.cooling.shell.tip_given = True
    rotor.coolinggen.design.cooling.shell.tip = 2.25
    assert live.busy(rotor)
    live.cancel()
    assert not live.busy(rotor) and not blades.up_to_date(rotor)
    bpy.ops.ed.undo_push(message="changed, not shown")
    bpy.ops.coolinggen.update()
    bpy.ops.ed.undo_push(message="shown")
    bpy.ops.ed.undo()
    rotor = bpy.data.collections["rotor"]
    assert not blades.up_to_date(rotor) and live.busy(rotor)


def test_all_faults_are_told_and_the_blade_stays(rotor):
    blades = part("blades")
    faces = len(blades.objects(rotor)["metal"].data.polygons)
    design = blades.design(rotor)
    design["cooling"]["walls"][0]["position"] = 0.9
    design["cooling"]["walls"][1]["position"] = 0.1
    design["cooling"]["chambers"][0]["fillet_radius"] = 500.0
    blades.set_design(rotor, design)
    with pytest.raises(RuntimeError):
        bpy.ops.coolinggen.update()
    settings = rotor.coolinggen
    assert settings.failure and settings.faults
    assert all(fault.pointer.startswith("/cooling") and fault.message for fault in settings.faults)
    assert len(blades.objects(rotor)["metal"].data.polygons) == faces


def test_the_sidecar_is_started_again_when_it_has_died(rotor):
    service = part("service")
    process = service.sidecar("")._process
    process.kill()
    process.wait()
    assert bpy.ops.coolinggen.update() == {"FINISHED"}


def test_a_sidecar_that_is_killed_at_work_is_told(rotor):
    blades, live, service = part("blades"), part("live"), part("service")
    faces = len(blades.objects(rotor)["metal"].data.polygons)
    rotor.coolinggen.chord_mm = 0.001
    server = service.sidecar("")
    # It cannot be done before it is dead.
    server._process.send_signal(signal.SIGSTOP)
    live._start(rotor)
    while not server._waiting:
        time.sleep(0.01)
    assert live.busy(rotor)
    server._process.kill()
    part("beside").wait(live._key(rotor.session_uid))
    assert "has ended" in rotor.coolinggen.failure
    assert len(blades.objects(rotor)["metal"].data.polygons) == faces
    rotor.coolinggen.chord_mm = 0.05
    assert bpy.ops.coolinggen.update() == {"FINISHED"} and not rotor.coolinggen.failure


def test_a_program_that_is_no_sidecar_is_told(rotor, tmp_path):
    service = part("service")
    service.stop()
    old = tmp_path / "coolinggen"
    reply = {"jsonrpc": "2.0", "id": 1, "error": {"code": -32602, "message": "speaks protocol 0", "data": []}}
    # It waits to be asked: an answer that comes before its question belongs to none.
    old.write_text(f"#!{sys.executable}\ninput()\nprint('''{json.dumps(reply)}''', flush=True)\ninput()\n")
    old.chmod(old.stat().st_mode | stat.S_IXUSR)
    bpy.context.preferences.addons[MODULE].preferences.binary = str(old)
    with pytest.raises(RuntimeError, match="speaks protocol 0"):
        bpy.ops.coolinggen.update()
    with pytest.raises(RuntimeError, match="speaks protocol 0"):
        bpy.ops.coolinggen.test()
    bpy.context.preferences.addons[MODULE].preferences.binary = ""
    assert bpy.ops.coolinggen.test() == {"FINISHED"}
    assert "coolinggen" in bpy.context.preferences.addons[MODULE].preferences.tested


def test_changes_wait_for_the_last_and_can_be_given_up(rotor):
    blades, live = part("blades"), part("live")
    shown = rotor.coolinggen.built
    cooling = rotor.coolinggen.design.cooling
    cooling.shell.tip_given = True
    for tip in (2.0, 2.1, 2.2):
        cooling.shell.tip = tip
    assert live.busy(rotor)
    assert bpy.ops.coolinggen.cancel() == {"FINISHED"}
    assert not live.busy(rotor) and rotor.coolinggen.built == shown
    rotor.coolinggen.live = False
    cooling.shell.tip = 2.3
    assert not live.busy(rotor)
    bpy.ops.coolinggen.update()
    assert blades.up_to_date(rotor)
