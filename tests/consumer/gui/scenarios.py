"""What a user does in the workbench, played by driver.py inside FreeCAD."""

import json
import os
from pathlib import Path

import FreeCAD as App
import FreeCADGui as Gui
import Part
from PySide import QtCore, QtGui

FOLDER = Path(os.environ["COOLINGGEN_GUI_FOLDER"])


def _panel():
    from freecad.coolinggen import panel

    return panel.active


def _idle() -> bool:
    """The preview is that of the design in the form."""
    p = _panel()
    return p is not None and p.settled and p.previewed == p.design


def _refused() -> bool:
    p = _panel()
    return p.settled and bool(p.faults)


def _closed() -> bool:
    return _panel() is None and not Gui.Control.activeDialog()


def _blade():
    return next(obj for obj in App.ActiveDocument.Objects if "Design" in obj.PropertiesList)


def _volumes() -> dict:
    return {child.SolidName: child.Shape.Volume for child in _blade().Solids}


def _new(user, template: str):
    """New cooled blade, from a template, up to its preview."""

    def choose(dialog) -> None:
        box = dialog.findChild(QtGui.QComboBox)
        box.setCurrentIndex(box.findText(template))
        dialog.accept()

    user.run("New", choose)
    yield lambda: _panel() is not None
    yield _idle


def _made(user, template: str = "rotor"):
    yield from _new(user, template)
    user.press("Ok")
    yield _closed


def _pause(seconds: float):
    clock = QtCore.QElapsedTimer()
    clock.start()
    yield lambda: clock.elapsed() > 1000 * seconds


def _open(user, section: str) -> None:
    user.click(f"section:{section}")


def make(user):
    """A blade from a template: preview, solids, colours."""
    yield from _new(user, "rotor")
    user.notes["triangles"] = _panel().preview.shown
    user.notes["objects_before"] = len(App.ActiveDocument.Objects)
    yield from _pause(1)
    user.screen("preview")
    user.press("Ok")
    yield _closed
    report = json.loads(_blade().Report)
    user.notes["volumes"] = _volumes()
    user.notes["reported"] = {n: s["volume_mm3"] for n, s in report["solids"].items()}
    metal = _blade().Solids[0]
    user.notes["colors"] = len({tuple(c) for c in metal.ViewObject.DiffuseColor})
    user.notes["faces"] = len(metal.ViewObject.DiffuseColor) == len(metal.Shape.Faces)
    user.notes["undo"] = App.ActiveDocument.UndoNames
    yield from _pause(1)
    user.screen("made")
    user.view("made-view")


def edit(user):
    """A number typed, in the user's unit; a preview; OK; undo and redo. Cancel leaves everything."""
    yield from _made(user)
    before = _volumes()
    design = _blade().Design
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(_blade().Solids[0])
    user.run("Edit")
    yield _idle
    _open(user, "Shell")
    user.type("/cooling/shell/tip", "1000 um")
    yield _idle
    user.notes["typed"] = _panel().design["cooling"]["shell"]["tip"]
    user.notes["latency_s"] = _panel().latency_s
    user.screen("edit")
    user.press("Cancel")
    yield _closed
    user.notes["cancelled"] = _blade().Design == design and _volumes() == before
    user.notes["visible"] = [c.ViewObject.Visibility for c in _blade().Solids]
    user.notes["left"] = Gui.ActiveDocument.ActiveView.getSceneGraph().getByName("CoolingGenPreview") is None
    _blade().ViewObject.Proxy.doubleClicked(_blade().ViewObject)
    yield _idle
    _open(user, "Shell")
    user.type("/cooling/shell/tip", "0.05 in")
    yield _idle
    user.press("Ok")
    yield _closed
    user.notes["inches"] = json.loads(_blade().Design)["cooling"]["shell"]["tip"]
    after = _volumes()
    user.notes["grown"] = after["metal"] > before["metal"]
    App.ActiveDocument.undo()
    user.notes["undone"] = _volumes() == before and _blade().Design == design
    App.ActiveDocument.redo()
    user.notes["redone"] = _volumes() == after
    user.notes["colors"] = len({tuple(c) for c in _blade().Solids[0].ViewObject.DiffuseColor})


def lists(user):
    """Walls duplicated and removed, a film row added, a law drawn, an optional field ticked."""
    yield from _new(user, "rotor")
    design = _panel().design["cooling"]
    _open(user, "Walls")
    first = design["walls"][0]["name"]
    user.click("/cooling/walls:duplicate")
    user.notes["walls"] = [wall["name"] for wall in design["walls"]]
    yield _refused
    user.notes["why"] = [_panel().wrong.item(k).text() for k in range(_panel().wrong.count())]
    user.screen("refused")
    user.click("/cooling/walls:remove")
    user.notes["removed"] = [wall["name"] for wall in design["walls"]]
    yield _idle
    user.notes["no_faults"] = not _panel().faults and not _panel().wrong.isVisible()
    _open(user, "Walls")
    _open(user, "Film rows")
    user.click("/cooling/film_rows:add")
    yield _idle
    user.notes["film_rows"] = len(design["film_rows"])
    yield from _pause(0.5)
    user.screen("film")
    user.notes["first"] = first


def wrong(user):
    """A thickness that is too small is told at its field, and a click on it goes there."""
    yield from _made(user)
    user.run("Edit")
    yield _idle
    _open(user, "Shell")
    user.type("/cooling/shell/tip", "-1 mm")
    yield _refused
    user.notes["pointer"] = _panel().faults[0]["pointer"]
    item = _panel().wrong.item(0)
    user.notes["told"] = item.text()
    _open(user, "Shell")
    place = _panel().wrong.visualItemRect(item).center()
    user.click(_panel().wrong.viewport(), place.x(), place.y())
    user.notes["shown"] = user.widget("/cooling/shell/tip").isVisible()
    user.screen("wrong")
    user.press("Ok")
    yield _refused
    user.notes["still_open"] = _panel() is not None
    user.type("/cooling/shell/tip", "1.3 mm")
    yield _idle
    user.press("Ok")
    yield _closed


def killed(user):
    """The sidecar dies while it works: the panel says so, and the next edit starts it again."""
    from freecad.coolinggen import service

    yield from _new(user, "rotor-serpentine")
    _open(user, "Shell")
    user.type("/cooling/shell/tip", "1.3 mm")
    yield lambda: _panel().worker.busy
    service.sidecar()._process.kill()
    yield lambda: not _panel().worker.busy
    yield from _pause(0.2)
    user.notes["status"] = _panel().status.text()
    user.type("/cooling/shell/tip", "1.25 mm")
    yield _idle
    user.notes["alive"] = service.sidecar().alive
    user.press("Cancel")
    yield _closed
    user.notes["objects"] = len(App.ActiveDocument.Objects)


def alive(user):
    """While the solids of a blade with many holes are built the window answers; Cancel ends the build."""
    yield from _new(user, "rotor-serpentine")
    clock, gaps = QtCore.QElapsedTimer(), []
    clock.start()
    beat = QtCore.QTimer()
    beat.timeout.connect(lambda: gaps.append(clock.restart()))
    beat.start(10)
    user.press("Ok")
    yield from _pause(1.5)
    user.press("Cancel")
    yield lambda: not _panel().worker.busy and not _panel()._building
    beat.stop()
    user.notes["longest_ms"] = max(gaps)
    user.notes["still_open"] = _panel() is not None
    user.notes["objects"] = len(App.ActiveDocument.Objects)
    user.press("Cancel")
    yield _closed


def saved(user):
    """Saved and opened again: shapes, colours, names and life."""
    yield from _made(user)
    before, colors = _volumes(), [tuple(c) for c in _blade().Solids[0].ViewObject.DiffuseColor]
    names = list(_blade().Solids[0].FaceNames)
    path = FOLDER / "with space \u00e4.FCStd"
    App.ActiveDocument.saveAs(str(path))
    App.closeDocument(App.ActiveDocument.Name)
    App.openDocument(str(path))
    after = _volumes()
    user.notes["same"] = all(abs(after[n] / v - 1) < 1e-9 for n, v in before.items())
    shown = [tuple(c) for c in _blade().Solids[0].ViewObject.DiffuseColor]
    # The file has a byte for each part of a colour.
    user.notes["colors"] = all(
        abs(a - b) < 0.01 for c, d in zip(shown, colors, strict=True) for a, b in zip(c, d, strict=True)
    )
    user.notes["names"] = list(_blade().Solids[0].FaceNames) == names
    yield from _pause(0.3)
    _blade().ViewObject.Proxy.doubleClicked(_blade().ViewObject)
    yield _idle
    user.notes["children"] = len(_blade().ViewObject.Proxy.claimChildren())
    user.press("Cancel")
    yield _closed


def selected(user):
    """A blade's surface in FreeCAD, moved and turned, is cooled where it lies."""
    from freecad.coolinggen import service

    source = next(d for d in service.templates() if d["name"] == "surface")["blade"]
    surface = Part.BSplineSurface()
    knots = {}
    for way in "uv":
        listed = source[f"knots_{way}"]
        knots[way] = sorted(set(listed)), [listed.count(k) for k in sorted(set(listed))]
    surface.buildFromPolesMultsKnots(
        [[App.Vector(*p) for p in row] for row in source["points"]],
        knots["u"][1], knots["v"][1], knots["u"][0], knots["v"][0],
        False, False, source["degree_u"], source["degree_v"],
    )  # fmt: skip
    document = App.newDocument("Selected")
    feature = document.addObject("Part::Feature", "Drawn")
    feature.Shape = surface.toShape()
    feature.Placement = App.Placement(App.Vector(10, 200, -30), App.Rotation(App.Vector(1, 1, 0), 40))
    document.recompute()
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(feature, "Face1")
    user.run("FromSelection")
    yield _idle
    user.press("Ok")
    yield _closed
    metal = _blade().Solids[0].Shape
    user.notes["valid"] = metal.isValid()
    # Points of the blade's sides lie on the face that was selected.
    names = _blade().Solids[0].FaceNames
    sides = [f for n, f in zip(names, metal.Faces, strict=True) if n.startswith("blade/") and "side" in n]
    drawn = feature.Shape.Faces[0]
    middles = [(e, (e.FirstParameter + e.LastParameter) / 2) for f in sides for e in f.Edges]
    points = [edge.valueAt(t) for edge, t in middles]
    user.notes["off_mm"] = max(drawn.distToShape(Part.Vertex(p))[0] for p in points)
    user.notes["sides"] = len(sides)
    yield from _pause(0.5)
    user.screen("selected")


def tools(user):
    """Faces by name, groups, report, colours, export."""
    from freecad.coolinggen import faces

    yield from _made(user)
    metal = _blade().Solids[0]

    def choose(dialog) -> None:
        dialog.findChild(QtGui.QComboBox).setEditText("blade/*_side")
        dialog.accept()

    user.run("SelectFaces", choose)
    chosen = Gui.Selection.getSelectionEx()
    user.notes["selected"] = sorted(faces.name_of(metal, n) for n in chosen[0].SubElementNames)
    user.run("Groups")
    members = [o for o in App.ActiveDocument.Objects if "References" in o.PropertiesList]
    user.notes["groups"] = len(members)
    user.run("Report")
    yield from _pause(0.5)
    user.screen("report")
    table = user.widget("solids")
    user.notes["solids"] = table.rowCount()
    folder = FOLDER / "exported \u00fc"

    def formats(dialog) -> None:
        for box in dialog.formats.values():
            box.setChecked(True)
        dialog.folder.setText(str(folder))
        dialog.accept()

    user.run("Export", formats)
    user.notes["files"] = sorted(p.name for p in folder.iterdir())
    user.notes["blade"] = _blade().Label


def preferences(user):
    """The preferences page finds the sidecar, and says what is wrong with another program."""
    from freecad.coolinggen import preferences, service

    page = preferences.Page()
    page.loadSettings()
    page.form.show()
    user.click(page.test)
    user.notes["found"] = page.answer.text()
    user.type(page.path, "/bin/cat")
    user.click(page.test)
    user.notes["cat"] = page.answer.text()
    user.type(page.path, "/nowhere/coolinggen")
    user.click(page.test)
    user.notes["nowhere"] = page.answer.text()
    page.saveSettings()
    user.notes["saved"] = service.preferred()
    told = []
    service.templates.cache_clear()
    user.run("New", lambda dialog: (told.append(dialog.text()), dialog.accept()))
    user.notes["missing"] = told
    page.path.setText("")
    page.saveSettings()
    page.form.close()
    yield lambda: True


def thickness(user):
    """Wall thickness as colours between the design's least and its greatest, and away again."""
    from freecad.coolinggen import thickness as shown

    yield from _made(user)
    metal = _blade().Solids[0].ViewObject
    user.run("Thickness")
    (made,) = shown._shown.values()
    user.notes["range"] = made.range
    user.notes["glass"] = metal.Transparency
    yield from _pause(0.5)
    user.screen("7-thickness")
    user.run("Thickness")
    user.notes["away"] = not shown._shown and metal.Transparency == 0


SCENARIOS = {
    f.__name__: f
    for f in (make, edit, lists, wrong, killed, alive, saved, selected, tools, thickness, preferences)
}
