"""The tutorial of docs/freecad.md, step by step; each picture is one of its."""

import FreeCADGui as Gui
from freecad.coolinggen import report_view
from scenarios import _blade, _closed, _idle, _new, _open, _panel, _pause, _refused


def tutorial(user):
    """From a template to a report."""
    yield from _new(user, "rotor")
    yield from _pause(1)
    user.screen("1-new")
    _open(user, "Chambers")
    user.click("look:glass")
    user.click("look:coolant")
    yield from _pause(0.5)
    user.screen("2-see-through")
    _open(user, "Chambers")
    user.click("look:glass")
    _open(user, "Film rows")
    user.click("/cooling/film_rows:add")
    yield _idle
    yield from _pause(0.5)
    _panel().reveal("/cooling/film_rows/0/span")
    yield from _pause(0.5)
    user.screen("3-film-row")
    _open(user, "Film rows")
    _open(user, "Shell")
    user.type("/cooling/shell/tip", "80 mm")
    yield _refused
    yield from _pause(0.3)
    user.screen("4-refused")
    user.type("/cooling/shell/tip", "1.2 mm")
    yield _idle
    user.press("Ok")
    yield _closed
    yield from _pause(1)
    user.screen("5-solids")
    Gui.Selection.addSelection(_blade())
    user.run("Report")
    yield from _pause(0.3)
    Gui.Selection.clearSelection()
    tabs = report_view.show(_blade()).tabs
    names = [tabs.tabText(k) for k in range(tabs.count())]
    tabs.setCurrentIndex(next(k for k, name in enumerate(names) if name.startswith("Holes")))
    tabs.currentWidget().selectRow(4)
    yield from _pause(0.5)
    user.screen("6-report")
    Gui.Selection.clearSelection()
    user.run("Thickness")
    yield from _pause(0.7)
    user.screen("7-thickness")
    user.run("Thickness")


SCENARIOS = {"tutorial": tutorial}
