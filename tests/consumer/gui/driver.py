"""Runs inside FreeCAD's window: plays scenarios one after the other and writes down how they went.

A scenario is a generator: it presses what a user would, and yields what it waits for, a function that
says whether it has come. Between two looks FreeCAD lives on by itself.
"""

import importlib
import json
import os
import sys
import time
import traceback
from pathlib import Path

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

FOLDER = Path(os.environ["COOLINGGEN_GUI_FOLDER"])
PATIENCE_S = float(os.environ.get("COOLINGGEN_GUI_PATIENCE", "90"))
WINDOW = (1400, 900)


class User:
    """What a scenario presses and looks at."""

    def __init__(self, name: str):
        self.name = name
        self.notes: dict = {}

    def run(self, command: str, answer=None) -> None:
        """Presses the button of a command in its toolbar, if it is enabled; ``answer`` is given to the
        dialog that it opens.
        """
        known = Gui.Command.get(f"CoolingGen_{command}")
        text = known.getInfo()["menuText"]
        assert known.isActive(), f"{text} is not to be pressed now"
        bar = Gui.getMainWindow().findChild(QtGui.QToolBar, "CoolingGen")
        for action in bar.actions():
            if action.text().replace("&", "") == text:
                # FreeCAD's timer would do so within a third of a second.
                action.setEnabled(True)
                if answer is not None:
                    self.soon(answer)
                action.trigger()
                return
        raise AssertionError(f"there is no button {text}")

    def widget(self, name: str):
        """The visible widget of this name."""
        found = [w for w in QtGui.QApplication.allWidgets() if w.objectName() == name and w.isVisible()]
        assert found, f"there is no {name}"
        return found[0]

    def click(self, widget, x: int | None = None, y: int | None = None) -> None:
        """Presses and releases the left mouse button over a widget."""
        if isinstance(widget, str):
            widget = self.widget(widget)
        place = widget.rect().center() if x is None else QtCore.QPoint(x, y)
        for kind, held in (
            (QtCore.QEvent.MouseButtonPress, QtCore.Qt.LeftButton),
            (QtCore.QEvent.MouseButtonRelease, QtCore.Qt.NoButton),
        ):
            far = widget.mapToGlobal(place)
            event = QtGui.QMouseEvent(kind, place, far, QtCore.Qt.LeftButton, held, QtCore.Qt.NoModifier)
            QtGui.QApplication.sendEvent(widget, event)

    def type(self, widget, text: str) -> None:
        """Types a text over what stands in a line or a box of numbers."""
        if isinstance(widget, str):
            widget = self.widget(widget)
        lines = [line for line in widget.findChildren(QtGui.QLineEdit) if line.isVisible()]
        line = widget if isinstance(widget, QtGui.QLineEdit) else lines[0]
        line.selectAll()
        for key in text:
            for kind in (QtCore.QEvent.KeyPress, QtCore.QEvent.KeyRelease):
                event = QtGui.QKeyEvent(kind, 0, QtCore.Qt.NoModifier, key)
                QtGui.QApplication.sendEvent(line, event)

    def press(self, standard: str) -> None:
        """Presses OK or Cancel of the task panel."""
        kind = getattr(QtGui.QDialogButtonBox, standard)
        boxes = Gui.getMainWindow().findChildren(QtGui.QDialogButtonBox)
        buttons = [b for box in boxes if box.isVisible() and (b := box.button(kind)) is not None]
        assert buttons, f"there is no {standard}"
        self.click(buttons[0])

    def soon(self, act) -> None:
        """Acts on the next modal dialog; for commands that wait for one."""

        def look() -> None:
            dialog = QtGui.QApplication.activeModalWidget()
            if dialog is None:
                QtCore.QTimer.singleShot(50, look)
            else:
                act(dialog)

        QtCore.QTimer.singleShot(100, look)

    def screen(self, name: str) -> None:
        """A picture of the whole window."""
        Gui.updateGui()
        screen = Gui.getMainWindow().windowHandle().screen()
        screen.grabWindow(0).save(str(FOLDER / f"{name}.png"))

    def view(self, name: str, background: str = "White") -> None:
        """A picture of the 3D view alone."""
        Gui.updateGui()
        Gui.ActiveDocument.ActiveView.saveImage(str(FOLDER / f"{name}.png"), 800, 600, background)

    def messages(self) -> str:
        """What the report view says."""
        view = Gui.getMainWindow().findChild(QtGui.QTextEdit, "Report view")
        return view.toPlainText() if view is not None else ""


class Player(QtCore.QObject):
    """Plays scenarios."""

    def __init__(self, scenarios: dict):
        super().__init__()
        self.waiting = list(scenarios.items())
        self.told: dict = {}
        self.steps = None
        self.condition = None
        self.since = time.monotonic()
        self.timer = QtCore.QTimer()
        self.timer.timeout.connect(self.look)
        self.timer.start(20)
        self.busy = False

    def look(self) -> None:
        # A scenario's own step may run an event loop, that of a dialog: which must not wait for ever.
        if self.busy:
            dialog = QtGui.QApplication.activeModalWidget()
            if dialog is not None and time.monotonic() - self.since > PATIENCE_S:
                dialog.reject()
            return
        self.busy = True
        try:
            self.step()
        finally:
            self.busy = False

    def step(self) -> None:
        if self.steps is None:
            if not self.waiting:
                self.end()
                return
            name, scenario = self.waiting.pop(0)
            self.user = User(name)
            self.steps, self.condition, self.begun = scenario(self.user), None, time.monotonic()
            self.since = self.begun
        try:
            if self.condition is not None and not self.condition():
                if time.monotonic() - self.since > PATIENCE_S:
                    where = self.steps.gi_frame.f_lineno if self.steps.gi_frame else "?"
                    raise AssertionError(f"waited in vain at line {where}")
                return
            self.condition = next(self.steps)
            self.since = time.monotonic()
        except StopIteration:
            self.done("")
        except BaseException:
            self.done(traceback.format_exc())

    def done(self, error: str) -> None:
        if error:
            self.user.screen(f"{self.user.name}-failed")
        self.told[self.user.name] = {
            "error": error,
            "notes": self.user.notes,
            "seconds": time.monotonic() - self.begun,
        }
        (FOLDER / "told.json").write_text(json.dumps(self.told), encoding="utf-8")
        self.steps = None
        clear()

    def end(self) -> None:
        self.timer.stop()
        (FOLDER / "done").write_text("", encoding="utf-8")
        from freecad.coolinggen import service

        service.stop()
        os._exit(0)


def clear() -> None:
    """Leaves nothing of a scenario behind."""
    from freecad.coolinggen import panel

    if panel.active is not None:
        panel.active._building = False
        panel.active.reject()
    Gui.Control.closeDialog()
    for name in list(App.listDocuments()):
        App.closeDocument(name)


def begin() -> None:
    window = Gui.getMainWindow()
    window.setGeometry(0, 0, *WINDOW)
    Gui.activateWorkbench("CoolingGenWorkbench")
    for title in ("Start page",):
        for sub in window.findChildren(QtGui.QMdiSubWindow):
            if sub.windowTitle() == title:
                sub.close()
    known = {}
    for file in map(Path, os.environ["COOLINGGEN_GUI_SCENARIOS"].split(os.pathsep)):
        sys.path.insert(0, str(file.parent))
        known |= importlib.import_module(file.stem).SCENARIOS
    wanted = os.environ.get("COOLINGGEN_GUI_WANTED", "").split(",")
    chosen = {n: s for n, s in known.items() if wanted == [""] or n in wanted}
    begin.player = Player(chosen)


QtCore.QTimer.singleShot(800, begin)
