"""The report in a window beside the tree: what is wrong, solids, passages, and every kind of bore.

A click on a line selects its faces, one on a fault opens its field.
"""

import json

import FreeCADGui as Gui
from PySide import QtCore, QtGui

from . import blade, faces, panel
from .client.forms import title

#: Lists of the report that are shown as tables, if it has them.
TABLES = ("passages", "holes", "slots", "crossovers", "pins", "inserts", "jets", "dust_holes", "radial_holes")
#: Values of a line that a table shows: numbers, words, and short lists of numbers.
LONGEST = 3


class ReportView(QtGui.QDockWidget):
    """Tables of a blade."""

    def __init__(self, parent):
        super().__init__("Cooled blade: report", parent)
        self.setObjectName("CoolingGenReport")
        self.tabs = QtGui.QTabWidget()
        self.setWidget(self.tabs)
        self._blade = None

    def fill(self, obj) -> None:
        """Shows the report of a blade."""
        self._blade = obj
        self.setWindowTitle(f"{obj.Label}: report")
        self.tabs.clear()
        faults = json.loads(obj.Faults) if obj.Faults else []
        if faults:
            wrong = QtGui.QListWidget()
            wrong.setObjectName("faults")
            for fault in faults:
                pointer = blade.pointer(fault)
                item = QtGui.QListWidgetItem(f"{pointer}: {panel.describe(fault)}")
                item.setData(QtCore.Qt.UserRole, pointer)
                wrong.addItem(item)
            wrong.itemClicked.connect(lambda item: self._mend(item.data(QtCore.Qt.UserRole)))
            self.tabs.addTab(wrong, f"Wrong ({len(faults)})")
        report = json.loads(obj.Report) if obj.Report else {}
        self._add("solids", [{"name": n, **values} for n, values in report.get("solids", {}).items()])
        for name in TABLES:
            self._add(name, report.get(name, []))
        self._summary(report)

    def _summary(self, report: dict) -> None:
        wall = report.get("wall_thickness_mm") or {}
        lines = [
            ("Watertight", report.get("watertight")),
            ("Edges off faces, mm", report.get("max_edge_deviation_mm")),
        ]
        if wall:
            lines += [("Thinnest wall, mm", wall["min"]), ("There", wall["face"]), ("At, mm", wall["at_mm"])]
        self._add("summary", [{"name": name, "value": value} for name, value in lines if value is not None])

    def _add(self, name: str, items: list[dict]) -> None:
        if not items:
            return
        columns = list(dict.fromkeys(key for item in items for key, value in item.items() if _short(value)))
        table = QtGui.QTableWidget(len(items), len(columns))
        table.setObjectName(name)
        table.setHorizontalHeaderLabels([_header(column) for column in columns])
        table.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
        table.setSelectionBehavior(QtGui.QAbstractItemView.SelectRows)
        for i, item in enumerate(items):
            for k, column in enumerate(columns):
                table.setItem(i, k, QtGui.QTableWidgetItem(_text(item.get(column))))
        table.resizeColumnsToContents()
        table.itemSelectionChanged.connect(lambda: self._select(table, items))
        self.tabs.addTab(table, f"{title(name)} ({len(items)})")

    def _select(self, table: QtGui.QTableWidget, items: list[dict]) -> None:
        row = table.currentRow()
        if not 0 <= row < len(items):
            return
        name = str(items[row].get("name", ""))
        for child in self._blade.Solids:
            if child.SolidName == name:
                Gui.Selection.clearSelection()
                Gui.Selection.addSelection(child)
                return
        faces.select(self._blade, name) or faces.select(self._blade, f"chamber/{name}")

    def _mend(self, pointer: str) -> None:
        if panel.active is None and not panel.edit(self._blade):
            return
        panel.active.reveal(pointer)


def _short(value: object) -> bool:
    if isinstance(value, list):
        return len(value) <= LONGEST and all(isinstance(v, int | float | str) for v in value)
    return isinstance(value, int | float | str | bool)


def _header(column: str) -> str:
    for suffix, unit in (
        ("_mm3", "mm\u00b3"),
        ("_mm2", "mm\u00b2"),
        ("_mm", "mm"),
        ("_deg", "\u00b0"),
        ("_d", "D"),
    ):
        if column.endswith(suffix):
            return f"{title(column.removesuffix(suffix))}, {unit}"
    return title(column)


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return f"{value:.6g}"
    if isinstance(value, list):
        return ", ".join(_text(v) for v in value)
    return "" if value is None else str(value)


def show(obj) -> ReportView:
    """Shows a blade's report in the one view of this window."""
    window = Gui.getMainWindow()
    view = window.findChild(QtGui.QDockWidget, "CoolingGenReport")
    if view is None:
        view = ReportView(window)
        window.addDockWidget(QtCore.Qt.BottomDockWidgetArea, view)
        messages = window.findChild(QtGui.QDockWidget, "Report view")
        if messages is not None and messages.isVisible():
            window.tabifyDockWidget(messages, view)
    view.fill(obj)
    view.show()
    view.raise_()
    return view
