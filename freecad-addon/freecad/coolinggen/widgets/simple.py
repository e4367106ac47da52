"""Widgets for single values. Each emits ``edited`` with the new value."""

import json

import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ..client.forms import Choice, Field, title

#: Lengths and angles are FreeCAD's quantities, so that they show in the user's units.
QUANTITIES = {"mm": "mm", "deg": "deg"}


class _Calm(QtCore.QObject):
    """Keeps the mouse wheel, meant for the panel, from turning numbers that it passes."""

    def eventFilter(self, widget, event) -> bool:  # noqa: N802 (Qt's name)
        if event.type() == QtCore.QEvent.Wheel and not widget.hasFocus():
            event.ignore()
            return True
        return False


_calm = _Calm()


def calm(widget):
    """The widget, deaf to the wheel unless it has the focus."""
    widget.setFocusPolicy(QtCore.Qt.StrongFocus)
    widget.installEventFilter(_calm)
    return widget


def narrow(widget):
    """The widget, content with the little room that a task panel has."""
    widget.setMinimumWidth(52)
    widget.setSizePolicy(QtGui.QSizePolicy.Ignored, QtGui.QSizePolicy.Fixed)
    return widget


class Editor(QtGui.QWidget):
    """A widget for a value of a field."""

    edited = QtCore.Signal(object)

    def __init__(self):
        super().__init__()
        self.line = QtGui.QHBoxLayout(self)
        self.line.setContentsMargins(0, 0, 0, 0)
        self.line.setSpacing(3)

    def show_value(self, value: object) -> None:
        """Shows a value without telling of it."""
        raise NotImplementedError


class NumberEditor(Editor):
    """A number: with a unit of FreeCAD's, or without one. ``fraction``: it runs from 0 to 1."""

    def __init__(self, unit: str = "", *, fraction: bool = False, plain: bool = False):
        super().__init__()
        self._quiet = False
        self.quantity = unit in QUANTITIES
        if self.quantity:
            self.spin = Gui.UiLoader().createWidget("Gui::QuantitySpinBox")
            self.spin.setProperty("unit", QUANTITIES[unit])
            # Wide open: a value beyond the limits is the design's to refuse, with its reason.
            QtCore.QObject.connect(self.spin, QtCore.SIGNAL("valueChanged(double)"), self._told)
            self.spin.setProperty("singleStep", 0.1 if unit == "mm" else 1.0)
        else:
            self.spin = QtGui.QDoubleSpinBox()
            self.spin.setDecimals(3 if fraction else 4)
            self.spin.setRange(-1e9, 1e9)
            self.spin.setSingleStep(0.01 if fraction else 0.1)
            self.spin.valueChanged.connect(self._told)
            if unit == "diameters":
                self.spin.setSuffix(" D")
        if plain:
            self.spin.setButtonSymbols(QtGui.QAbstractSpinBox.NoButtons)
        narrow(calm(self.spin))
        self.line.addWidget(self.spin)
        self.setFocusProxy(self.spin)

    def value(self) -> float:
        """What is shown: mm, degrees or a plain number."""
        return float(self.spin.property("rawValue")) if self.quantity else self.spin.value()

    def _told(self, *_) -> None:
        if not self._quiet:
            self.edited.emit(self.value())

    def show_value(self, value: object) -> None:
        self._quiet = True
        number = float(value) if isinstance(value, int | float) else 0.0
        if self.quantity:
            self.spin.setProperty("rawValue", number)
        else:
            self.spin.setValue(number)
        self._quiet = False


class IntegerEditor(Editor):
    """A whole number."""

    def __init__(self):
        super().__init__()
        self.spin = calm(QtGui.QSpinBox())
        self.spin.setRange(-(10**9), 10**9)
        self.spin.valueChanged.connect(lambda value: self.edited.emit(int(value)))
        self.line.addWidget(self.spin)
        self.setFocusProxy(self.spin)

    def show_value(self, value: object) -> None:
        self.spin.blockSignals(True)
        self.spin.setValue(int(value) if isinstance(value, int | float) else 0)
        self.spin.blockSignals(False)


class TextEditor(Editor):
    """A text; where it names something of the design, with what there is to choose from."""

    def __init__(self, names: list[str] | None = None):
        super().__init__()
        if names is None:
            self.box = None
            self.text = QtGui.QLineEdit()
            self.line.addWidget(self.text)
            self.setFocusProxy(self.text)
        else:
            self.box = narrow(calm(QtGui.QComboBox()))
            self.box.setEditable(True)
            self.box.addItems(names)
            self.text = self.box.lineEdit()
            self.line.addWidget(self.box)
            self.setFocusProxy(self.box)
        self.text.textChanged.connect(self.edited.emit)

    def show_value(self, value: object) -> None:
        widget = self.box or self.text
        widget.blockSignals(True)
        self.text.blockSignals(True)
        self.text.setText(value if isinstance(value, str) else "")
        self.text.blockSignals(False)
        widget.blockSignals(False)


class ChoiceEditor(Editor):
    """One of several words."""

    def __init__(self, choice: Choice):
        super().__init__()
        self.box = narrow(calm(QtGui.QComboBox()))
        for k, (word, told) in enumerate(choice.options):
            self.box.addItem(title(word), word)
            self.box.setItemData(k, told, QtCore.Qt.ToolTipRole)
        self.box.currentIndexChanged.connect(lambda k: self.edited.emit(self.box.itemData(k)))
        self.line.addWidget(self.box)
        self.setFocusProxy(self.box)

    def show_value(self, value: object) -> None:
        self.box.blockSignals(True)
        self.box.setCurrentIndex(max(self.box.findData(value), 0))
        self.box.blockSignals(False)


class BooleanEditor(Editor):
    """Yes or no."""

    def __init__(self):
        super().__init__()
        self.box = QtGui.QCheckBox()
        self.box.toggled.connect(self.edited.emit)
        self.line.addWidget(self.box)

    def show_value(self, value: object) -> None:
        self.box.blockSignals(True)
        self.box.setChecked(bool(value))
        self.box.blockSignals(False)


class RowEditor(Editor):
    """A fixed number of values beside each other; ``cells`` are their widgets, ``filler`` a value not
    given.
    """

    def __init__(self, cells: list[Editor], filler: object):
        super().__init__()
        self._value: list = []
        self._filler = filler
        self.cells = cells
        for k, cell in enumerate(cells):
            cell.edited.connect(lambda value, k=k: self._told(k, value))
            self.line.addWidget(cell)
        self.setFocusProxy(cells[0])

    def _told(self, k: int, value: object) -> None:
        self._value = [*self._value[:k], value, *self._value[k + 1 :]]
        self.edited.emit(list(self._value))

    def show_value(self, value: object) -> None:
        self._value = list(value) if isinstance(value, list) else []
        self._value += [self._filler] * (len(self.cells) - len(self._value))
        for cell, part in zip(self.cells, self._value, strict=False):
            cell.show_value(part)


class RawEditor(Editor):
    """Anything else: shown by its size, edited as JSON."""

    def __init__(self, field: Field):
        super().__init__()
        self._field = field
        self._value: object = None
        self.size = QtGui.QLabel()
        self.button = QtGui.QPushButton("Edit...")
        self.button.clicked.connect(self._edit)
        self.line.addWidget(self.size, 1)
        self.line.addWidget(self.button)

    def show_value(self, value: object) -> None:
        self._value = value
        self.size.setText(f"{len(value)} entries" if isinstance(value, list) else str(value or "")[:30])

    def _edit(self) -> None:
        before = json.dumps(self._value, indent=1)
        title, told = self._field.title, self._field.description
        text, done = QtGui.QInputDialog.getMultiLineText(self, title, told, before)
        if done:
            try:
                self._value = json.loads(text)
            except ValueError as error:
                QtGui.QMessageBox.warning(self, self._field.title, str(error))
            else:
                self.show_value(self._value)
                self.edited.emit(self._value)
