"""The task panel: a form of the design beside a live preview, exact solids on OK."""

import json
import time
from copy import deepcopy

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from . import blade, job
from .client import forms, paths
from .client.latest import Done, Latest
from .client.sidecar import CancelledError, RefusedError, SidecarError
from .preview import Preview
from .service import schema, templates
from .widgets import sections
from .widgets.context import Context
from .widgets.rows import WRONG, Line

#: An edit is previewed when nothing has been edited for so long, ms.
DEBOUNCE_MS = 150
#: The worker is asked what happened so often, ms.
POLL_MS = 30
#: Width that a form wants, pixels.
ROOM = 380


class Panel:
    """Edits a blade of the document, or makes a new one when it is accepted."""

    def __init__(self, document, design: dict, obj=None, *, file: str = "", placement=None):
        self.document, self.obj, self._file = document, obj, file
        self.placement = placement or (obj.Placement if obj is not None else App.Placement())
        self.design = deepcopy(design)
        self.context = Context(self.design, self._edited, templates())
        self.fields = [f for f in forms.form(schema()).fields if f.key != "format"]
        self.worker = Latest()
        self.previewed: dict | None = None  #: The design that the preview shows.
        self.faults: list[dict] = []
        self.latency_s = 0.0  #: From the last edit's submission to its preview.
        self._building = False
        self._edits = obj is not None
        self._asked = self._answered = 0
        self._begun = 0.0
        self._hidden = [] if obj is None else [c for c in obj.Solids if c.ViewObject.Visibility]
        self.form = self._widget()
        self._gui_view = Gui.getDocument(document.Name).ActiveView
        self.preview = Preview(self._gui_view)
        self.preview.place(self.placement)
        for child in self._hidden:
            child.ViewObject.Visibility = False
        self._debounce = QtCore.QTimer()
        self._debounce.setSingleShot(True)
        self._debounce.timeout.connect(self._preview)
        self._poll = QtCore.QTimer()
        self._poll.timeout.connect(self._news)
        self._poll.start(POLL_MS)
        self._preview()

    def replaces(self, drawn) -> None:
        """The blade stands in the place of ``drawn``, which is hidden; Cancel shows it again."""
        if drawn.ViewObject.Visibility:
            drawn.ViewObject.Visibility = False
            self._hidden.append(drawn)

    # The widget

    def _widget(self) -> QtGui.QWidget:
        widget = QtGui.QWidget()
        widget.setWindowTitle("Cooled blade")
        widget.setWindowIcon(QtGui.QIcon(_icon()))
        box = QtGui.QVBoxLayout(widget)
        box.setSpacing(2)
        box.setContentsMargins(2, 2, 2, 2)
        self.status = QtGui.QLabel()
        self.status.setObjectName("status")
        self.status.setWordWrap(True)
        self.progress = QtGui.QProgressBar()
        self.progress.setRange(0, 100)
        self.progress.setTextVisible(False)
        self.progress.setMaximumHeight(6)
        self.wrong = QtGui.QListWidget()
        self.wrong.setObjectName("faults")
        self.wrong.setStyleSheet(WRONG)
        self.wrong.setWordWrap(True)
        self.wrong.setMaximumHeight(90)
        self.wrong.itemClicked.connect(lambda item: self.reveal(item.data(QtCore.Qt.UserRole)))
        self.wrong.hide()
        for part in (self.status, self.progress, self.wrong):
            box.addWidget(part)
        box.addLayout(self._looks())
        self.sections = self._sections()
        for section in self.sections:
            box.addWidget(section)
        box.addStretch(1)
        return widget

    def _looks(self) -> QtGui.QHBoxLayout:
        line = QtGui.QHBoxLayout()
        self.looks = {}
        for name, title, on in (
            ("metal", "Metal", True),
            ("coolant", "Coolant", False),
            ("glass", "See through", False),
        ):
            box = QtGui.QCheckBox(title)
            box.setObjectName(f"look:{name}")
            box.setChecked(on)
            box.toggled.connect(lambda *_: self._look())
            line.addWidget(box)
            self.looks[name] = box
        return line

    def _look(self) -> None:
        self.preview.look(**{name: box.isChecked() for name, box in self.looks.items()})

    def _sections(self) -> list[sections.Section]:
        """One for each of the design's objects and of the cooling's, one for what is left of both."""
        general = [field for field in self.fields if sections.simple(field)]
        made = [self._section("General", "Name and description.", (), general)]
        for field in self.fields:
            if sections.simple(field):
                continue
            if field.key != "cooling":
                made.append(self._section(field.title, field.description, (), [field]))
                continue
            inside, rest = ("cooling",), []
            for part in field.shape.fields:
                if sections.simple(part):
                    rest.append(part)
                else:
                    made.append(self._section(part.title, part.description, inside, [part]))
            made.append(self._section("Cooling, more", field.description, inside, rest))
        return made

    def _section(
        self, title: str, told: str, path: paths.Path, fields: list[forms.Field]
    ) -> sections.Section:
        shown = [(*path, field.key) for field in fields]

        def make(layout: QtGui.QFormLayout) -> None:
            for field in fields:
                sections.add(field, (*path, field.key), self.context, layout)
            self._mark()

        return sections.Section(title, told, shown, self.context, make)

    def reveal(self, pointer: str) -> None:
        """Opens the form where the design's value at a JSON pointer is, and puts the cursor there."""
        path = paths.path(pointer)
        for section in self.sections:
            if any(path[: len(p)] == p for p in section.paths):
                section.button.setChecked(True)
        widget, seen = None, None
        while True:
            found, part = self.context.nearest(path)
            if part is None or found == seen:
                break
            seen = found
            widget = part.reveal(path[len(found) :])
        if widget is not None:
            widget.setFocus()
            QtCore.QTimer.singleShot(0, lambda: self._scroll_to(widget))

    @staticmethod
    def _scroll_to(widget: QtGui.QWidget) -> None:
        # Not by parentWidget: what it returns takes the widgets of other wrappers with it when it goes.
        for area in Gui.getMainWindow().findChildren(QtGui.QScrollArea):
            if area.isAncestorOf(widget):
                area.ensureWidgetVisible(widget)

    # The preview

    def _edited(self) -> None:
        self._debounce.start(DEBOUNCE_MS)

    def request(self) -> job.Request:
        """What is asked for the design as it stands in the form."""
        if self.obj is not None:
            wanted = blade.request(self.obj)
            name, folder = wanted.model, wanted.folder
            file = self.obj.BladeFile
        else:
            name, folder = f"{self.document.Uid}/new", ""
            file = self._file
        return job.Request(name, *blade.with_file(deepcopy(self.design), file, folder))

    def _preview(self) -> None:
        if self._building:
            return
        self._begun = time.monotonic()
        self._asked += 1
        wanted = self.request()
        tag = ("preview", deepcopy(self.design), self._asked)
        self.worker.submit(lambda watch: job.preview(wanted, watch), tag)
        self._tell("Working...")

    @property
    def settled(self) -> bool:
        """Whether the last edit has been answered."""
        return self._asked == self._answered and not self._debounce.isActive() and not self._building

    def _news(self) -> None:
        if not self._usable():
            return
        for news in self.worker.news():
            kind, design, number = news.tag
            if not isinstance(news, Done):
                self.progress.setValue(int(100 * news.fraction))
                continue
            self._answered = number
            if news.error is None and kind == "preview":
                self._previewed(news.result, design)
            elif news.error is None:
                self._built(news.result)
                return
            else:
                self._failed(news.error, kind)

    def _previewed(self, meshes: list, design: dict) -> None:
        self.latency_s = time.monotonic() - self._begun
        first = self.previewed is None and self.obj is None
        self.preview.show(meshes)
        self.previewed = design
        self._show_faults([])
        self._tell(f"{self.preview.shown:,} triangles in {self.latency_s:.2f} s")
        self.progress.setValue(0)
        if first:
            self._gui_view.viewIsometric()
            self._gui_view.fitAll()

    def _failed(self, error: Exception, kind: str) -> None:
        if kind == "build":
            self._building = False
            self.form.setEnabled(True)
        self.progress.setValue(0)
        if isinstance(error, CancelledError):
            if kind == "build":
                self._tell("Cancelled")
        elif isinstance(error, RefusedError):
            self._tell("The design cannot be built:")
            self._show_faults(error.faults)
        elif isinstance(error, SidecarError | OSError):
            self._tell(str(error), wrong=True)
        else:
            self._tell(f"{type(error).__name__}: {error}", wrong=True)

    def _tell(self, text: str, *, wrong: bool = False) -> None:
        self.status.setText(text)
        self.status.setStyleSheet(WRONG if wrong else "")

    # What is wrong

    def _show_faults(self, faults: list[dict]) -> None:
        self.faults = faults
        self.wrong.clear()
        for fault in faults:
            pointer = blade.pointer(fault)
            item = QtGui.QListWidgetItem(f"{pointer or '/'}: {describe(fault)}")
            item.setData(QtCore.Qt.UserRole, pointer)
            item.setToolTip(fault.get("hint") or "Click to see the field")
            self.wrong.addItem(item)
        self.wrong.setVisible(bool(faults))
        self._mark()

    def _mark(self) -> None:
        """Says at each field what is wrong with it."""
        self.context.unmark()
        places = [(paths.path(blade.pointer(fault)), fault) for fault in self.faults]
        for section in self.sections:
            section.warn(any(path[: len(p)] == p for path, _ in places for p in section.paths))
        for path, fault in places:
            _, part = self.context.nearest(path)
            if isinstance(part, Line | sections.Part):
                part.mark(describe(fault))

    # FreeCAD's questions

    def getStandardButtons(self) -> int:  # noqa: N802
        buttons = QtGui.QDialogButtonBox.Ok | QtGui.QDialogButtonBox.Cancel
        # A flag with a value in newer Qt, an integer of its own in older.
        return buttons.value if hasattr(buttons, "value") else int(buttons)

    def isAllowedAlterSelection(self) -> bool:  # noqa: N802
        return True

    def isAllowedAlterView(self) -> bool:  # noqa: N802
        return True

    def accept(self) -> bool:
        """Builds the solids beside the window; the panel closes when they are there."""
        if not self._building:
            self._debounce.stop()
            self._building = True
            self.form.setEnabled(False)
            self._tell("Building the solids...")
            self._asked += 1
            wanted, tag = self.request(), ("build", None, self._asked)
            self.worker.submit(lambda watch: job.build(wanted, watch, beside=True), tag)
        return False

    def reject(self) -> bool:
        """While the solids are built: gives that up. Otherwise closes; the document is as it was."""
        if self._building and self.worker.busy:
            self.worker.cancel()
            return False
        self._close()
        return True

    def _built(self, built: job.Built) -> None:
        text = json.dumps(self.design, indent=2)
        new = self.obj is None
        self.document.openTransaction("New cooled blade" if new else "Edit cooled blade")
        try:
            if new:
                self.obj = blade.new(
                    self.document, self.design, file=self._file, placement=self.placement, built=built
                )
            else:
                self.obj.Design = text
                blade.fill(self.obj, built)
                self.document.recompute()
        except Exception:
            self.document.abortTransaction()
            raise
        self.document.commitTransaction()
        self._hidden = []
        self._close()
        Gui.Control.closeDialog()
        if new:
            Gui.SendMsgToActiveView("ViewFit")

    def _usable(self) -> bool:
        """Whether document and widgets are still there; if not, this ends."""
        try:
            there = self.document.Name in App.listDocuments() and self.status.text() is not None
        except (ReferenceError, RuntimeError):
            there = False
        if not there:
            self._stop()
        return there

    def _stop(self) -> None:
        global active
        self._poll.stop()
        self._debounce.stop()
        self.worker.close()
        active = None

    def _close(self) -> None:
        """Leaves nothing behind."""
        self._stop()
        self.preview.clear()
        for child in self._hidden:
            child.ViewObject.Visibility = True
        gui = Gui.getDocument(self.document.Name)
        if self._edits and gui.getInEdit() is not None:
            gui.resetEdit()


#: The panel that is open.
active: Panel | None = None


def open_new(document, design: dict, *, file: str = "", placement=None) -> Panel:
    """A panel for a blade that will be there when it is accepted."""
    return _open(Panel(document, design, file=file, placement=placement))


def edit(obj) -> bool:
    """A panel for a blade; whether there is one now."""
    if active is not None:
        return False
    try:
        design = json.loads(obj.Design)
    except ValueError as error:
        App.Console.PrintError(f"{obj.Label}: its design is no JSON: {error}\n")
        return False
    panel = _open(Panel(obj.Document, design, obj))
    if obj.Faults:
        panel._show_faults(json.loads(obj.Faults))
    return True


def _open(panel: Panel) -> Panel:
    global active
    active = panel
    Gui.Control.showDialog(panel)
    _make_room()
    return panel


def _make_room() -> None:
    """Widens the window's part that has the task panel, where it is too narrow for a form."""
    window = Gui.getMainWindow()
    docks = [d for d in window.findChildren(QtGui.QDockWidget) if d.isVisible() and d.width() < ROOM]
    docks = [d for d in docks if d.objectName() in ("Combo View", "Tasks", "Task List")]
    if docks:
        window.resizeDocks(docks, [ROOM] * len(docks), QtCore.Qt.Horizontal)


def describe(fault: dict) -> str:
    """What is wrong, with value, limits and unit."""
    parts = [fault["message"]]
    value, low, high = fault.get("value"), fault.get("min"), fault.get("max")
    unit = f" {fault['unit']}" if fault.get("unit") else ""
    if isinstance(value, int | float) and not isinstance(value, bool):
        parts.append(f"it is {value:g}{unit}")
    if low is not None:
        parts.append(f"at least {low:g}{unit}")
    if high is not None:
        parts.append(f"at most {high:g}{unit}")
    return ", ".join(parts)


def _icon() -> str:
    from .view import icon

    return icon("blade")
