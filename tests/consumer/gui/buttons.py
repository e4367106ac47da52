"""The other buttons of the workbench, and folders that refuse files; played by driver.py inside FreeCAD."""

import json
import os
import shutil
from pathlib import Path

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui
from scenarios import FOLDER, _blade, _closed, _idle, _made, _panel, _pause, _volumes

SAMPLES = Path(__file__).parents[3] / "samples"


def _file(path: Path):
    """Answers a dialog that asks for a file."""

    def answer(dialog) -> None:
        dialog.findChild(QtGui.QLineEdit).setText(str(path))
        dialog.accept()

    return answer


def _accepted(user):
    """OK: the solids, which are what the report says."""
    yield _idle
    user.press("Ok")
    yield _closed
    told = json.loads(_blade().Report)["solids"]
    user.notes["off"] = max(abs(v / told[n]["volume_mm3"] - 1) for n, v in _volumes().items())
    user.notes["valid"] = all(child.Shape.isValid() for child in _blade().Solids)
    user.notes["label"] = _blade().Label


def from_design(user):
    """A blade from its file, in a folder with a space and a letter of its own."""
    folder = FOLDER / "designs \u00e4"
    folder.mkdir()
    shutil.copy(SAMPLES / "rotor.json", folder)
    user.run("FromDesign", _file(folder / "rotor.json"))
    yield from _accepted(user)


def from_step(user):
    """A blade from the surfaces of a STEP file, which the document keeps: the file may go."""
    folder = FOLDER / "steps \u00e4"
    folder.mkdir()
    file = shutil.copy(SAMPLES / "step-blade.step", folder)
    user.run("FromStep", _file(Path(file)))
    yield from _accepted(user)
    Path(file).unlink()
    before = _volumes()["metal"]
    user.run("Edit")
    yield _idle
    user.click("section:Shell")
    user.type("/cooling/shell/tip", "3 mm")
    yield _idle
    user.press("Ok")
    yield _closed
    user.notes["without_its_file"] = _volumes()["metal"] != before
    yield from _pause(0.3)
    user.screen("from-step")


def from_medial(user):
    """A blade from its angles and thickness: the form opens at these."""
    user.run("FromMedial")
    yield lambda: _panel() is not None
    user.notes["open"] = any(s.button.isChecked() and ("blade",) in s.paths for s in _panel().sections)
    yield from _accepted(user)
    yield from _pause(0.3)
    user.screen("from-medial")


def rebuild(user):
    """Built again and the same; colours of the user's own, and by region again."""
    yield from _made(user)
    before, metal = _volumes(), _blade().Solids[0].ViewObject
    user.run("Rebuild")
    user.notes["same"] = _volumes() == before
    user.notes["undo"] = App.ActiveDocument.UndoNames[0]
    regions = list(metal.DiffuseColor)
    metal.DiffuseColor = [(1.0, 0.0, 0.0)]
    user.run("Regions")
    user.notes["regions"] = list(metal.DiffuseColor) == regions and len(set(regions)) > 2


def report(user):
    """A click on a line of the report selects its solid or faces, one on a fault goes to its field."""
    yield from _made(user)
    user.run("Report")
    yield from _pause(0.3)

    def click(name: str, row: int) -> list:
        tabs = user.widget("CoolingGenReport").widget()
        table = tabs.findChild(QtGui.QTableWidget, name)
        tabs.setCurrentWidget(table)
        place = table.visualItemRect(table.item(row, 0)).center()
        user.click(table.viewport(), place.x(), place.y())
        chosen = Gui.Selection.getSelectionEx()
        return [[found.Object.SolidName, len(found.SubElementNames)] for found in chosen]

    user.notes["solid"] = click("solids", 0)
    user.notes["passage"] = click("passages", 0)
    user.screen("report-passage")
    design = json.loads(_blade().Design)
    design["cooling"]["shell"]["tip"] = 80.0
    _blade().Design = json.dumps(design)
    App.ActiveDocument.recompute()
    user.run("Report")
    yield from _pause(0.3)
    faults = user.widget("faults")
    place = faults.visualItemRect(faults.item(0)).center()
    user.notes["fault"] = faults.item(0).text()
    user.click(faults.viewport(), place.x(), place.y())
    yield lambda: _panel() is not None
    yield from _pause(0.3)
    user.notes["field"] = user.widget("/cooling/shell/tip").isVisible()
    user.screen("report-fault")
    user.press("Cancel")
    yield _closed


def refusing(user):
    """Folders that take no files: FreeCAD says which and why, and nothing half is left."""
    yield from _made(user)
    for name in ("read-only", "full"):
        folder = FOLDER / name
        if not os.path.ismount(folder):
            user.notes[name] = "no such folder here"
            continue
        before, told = sorted(folder.iterdir()), []

        def formats(dialog, folder=folder, told=told) -> None:
            dialog.formats["step"].setChecked(True)
            dialog.folder.setText(str(folder))
            QtCore.QTimer.singleShot(0, lambda: user.soon(lambda box: (told.append(box), _text(box, told))))
            dialog.accept()

        user.run("Export", formats)
        user.notes[name] = told[1:]
        user.notes[f"{name} left"] = sorted(folder.iterdir()) == before


def _text(box, told: list) -> None:
    if isinstance(box, QtGui.QMessageBox):
        told.append(box.text())
        box.accept()


SCENARIOS = {f.__name__: f for f in (from_design, from_step, from_medial, rebuild, report, refusing)}
