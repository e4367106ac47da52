"""Laws along the span, and tables of points."""

from PySide import QtCore, QtGui

from .simple import Editor, NumberEditor


def _button(text: str, told: str) -> QtGui.QToolButton:
    button = QtGui.QToolButton()
    button.setText(text)
    button.setToolTip(told)
    button.setAutoRaise(True)
    return button


class TableEditor(Editor):
    """Rows of numbers, each with a button that takes it away, and one below that adds another."""

    #: More rows than this are shown as a grid of plain numbers.
    FEW = 12

    def __init__(self, columns: int, unit: str, least: int = 0):
        super().__init__()
        self.columns, self.unit = columns, unit
        self._rows: list[list[float]] = []
        self._least = least
        self._grid: QtGui.QWidget | None = None

    def cells(self) -> list[NumberEditor]:
        """The widgets of another row."""
        return [NumberEditor(self.unit, plain=True) for _ in range(self.columns)]

    def show_value(self, value: object) -> None:
        self._rows = [list(row) for row in value] if isinstance(value, list) else []
        self._build()

    def _build(self) -> None:
        if self._grid is not None:
            self.line.removeWidget(self._grid)
            self._grid.hide()
            self._grid.deleteLater()
        self._grid = self._many() if len(self._rows) > self.FEW else self._few()
        self.line.addWidget(self._grid)

    def _few(self) -> QtGui.QWidget:
        widget = QtGui.QWidget()
        grid = QtGui.QGridLayout(widget)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(2)
        for k in range(self.columns):
            # A law's values with their units want more room than its span fractions.
            grid.setColumnStretch(k, 2 + k)
        for i, row in enumerate(self._rows):
            for k, cell in enumerate(self.cells()):
                cell.show_value(row[k] if k < len(row) else 0.0)
                cell.edited.connect(lambda value, i=i, k=k: self._put(i, k, value))
                grid.addWidget(cell, i, k)
            away = _button("\u2212", "Take this row away")
            away.setEnabled(len(self._rows) > self._least)
            away.clicked.connect(lambda *_, i=i: self._remove(i))
            grid.addWidget(away, i, self.columns)
        more = _button("+", "Another row")
        more.clicked.connect(lambda *_: self._add())
        grid.addWidget(more, len(self._rows), self.columns)
        return widget

    def _many(self) -> QtGui.QWidget:
        table = QtGui.QTableWidget(len(self._rows), self.columns)
        table.setHorizontalHeaderLabels([f"{k + 1} {self.unit}" for k in range(self.columns)])
        for i, row in enumerate(self._rows):
            for k, value in enumerate(row):
                table.setItem(i, k, QtGui.QTableWidgetItem(f"{value:.10g}"))
        table.setMinimumHeight(200)
        table.itemChanged.connect(self._typed)
        return table

    def _typed(self, item: QtGui.QTableWidgetItem) -> None:
        try:
            value = float(item.text().replace(",", "."))
        except ValueError:
            item.setText(f"{self._rows[item.row()][item.column()]:.10g}")
        else:
            self._put(item.row(), item.column(), value)

    def _put(self, i: int, k: int, value: float) -> None:
        self._rows[i][k] = value
        self._tell()

    def _remove(self, i: int) -> None:
        del self._rows[i]
        self._tell()
        QtCore.QTimer.singleShot(0, self._build)

    def _add(self) -> None:
        last = self._rows[-1] if self._rows else [0.0] * self.columns
        before = self._rows[-2] if len(self._rows) > 1 else last
        self._rows.append([2 * a - b for a, b in zip(last, before, strict=True)])
        self._tell()
        QtCore.QTimer.singleShot(0, self._build)

    def _tell(self) -> None:
        self.edited.emit([list(row) for row in self._rows])


class _LawTable(TableEditor):
    """Control points of a law: span fraction, value."""

    def cells(self) -> list[NumberEditor]:
        return [NumberEditor(fraction=True, plain=True), NumberEditor(self.unit)]

    def _add(self) -> None:
        """Another point in the middle of the widest gap."""
        rows = self._rows
        gaps = [(rows[k + 1][0] - rows[k][0], k) for k in range(len(rows) - 1)]
        _, k = max(gaps, default=(0.0, 0))
        a, b = rows[k], rows[min(k + 1, len(rows) - 1)]
        self._rows.insert(k + 1, [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2])
        self._tell()
        QtCore.QTimer.singleShot(0, self._build)


class LawEditor(Editor):
    """A number, or control points over the span fraction."""

    def __init__(self, unit: str):
        super().__init__()
        self._value: object = 0.0
        self.number = NumberEditor(unit)
        self.number.edited.connect(self._told)
        self.table = _LawTable(2, unit, least=2)
        self.table.edited.connect(self._told)
        self.kind = _button(
            "~", "A value that varies along the span: control points [v, value] of a B-spline"
        )
        self.kind.setCheckable(True)
        self.kind.clicked.connect(self._switch)
        self.line.addWidget(self.number, 1)
        self.line.addWidget(self.table, 1)
        self.line.addWidget(self.kind, 0, QtCore.Qt.AlignTop)
        self.setFocusProxy(self.number)

    def show_value(self, value: object) -> None:
        self._value = value
        varies = isinstance(value, list)
        self.kind.setChecked(varies)
        self.number.setVisible(not varies)
        self.table.setVisible(varies)
        (self.table if varies else self.number).show_value(value)

    def _told(self, value: object) -> None:
        self._value = value
        self.edited.emit(value)

    def _switch(self, varies: bool) -> None:
        if varies:
            number = float(self._value)
            value = [[0.0, number], [1.0, number]]
        else:
            points = self._value
            value = points[0][1] if points else 0.0
        self.show_value(value)
        self._told(value)
