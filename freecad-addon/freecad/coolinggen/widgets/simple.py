"""Widgets for single values. Each emits ``edited`` with the new value."""

import json

import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ..client import form

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


class Editor(QtGui.QWidget):
    """A widget for a value of a node."""

    edited = QtCore.Signal(object)

    def __init__(self, node: form.Node):
        super().__init__()
        self.node = node
        self.line = QtGui.QHBoxLayout(self)
        self.line.setContentsMargins(0, 0, 0, 0)
        self.line.setSpacing(3)

    def show_value(self, value: object) -> None:
        """Shows a value without telling of it."""
        raise NotImplementedError


class NumberEditor(Editor):
    """A number: with a unit of FreeCAD's, or without one."""

    def __init__(self, node: form.Node):
        super().__init__(node)
        self._quiet = False
        if node.unit in QUANTITIES:
            self.spin = Gui.UiLoader().createWidget("Gui::QuantitySpinBox")
            self.spin.setProperty("unit", QUANTITIES[node.unit])
            # Wide open: a value beyond the limits is the design's to refuse, with its reason.
            QtCore.QObject.connect(self.spin, QtCore.SIGNAL("valueChanged(double)"), self._told)
            self.spin.setProperty("singleStep", 0.1 if node.unit == "mm" else 1.0)
        else:
            self.spin = QtGui.QDoubleSpinBox()
            self.spin.setDecimals(4)
            self.spin.setRange(-1e9, 1e9)
            self.spin.setSingleStep(0.01 if node.maximum is not None and node.maximum <= 1 else 0.1)
            self.spin.valueChanged.connect(self._told)
            if node.unit == "diameters":
                self.spin.setSuffix(" D")
        calm(self.spin)
        self.spin.setMinimumWidth(60)
        self.line.addWidget(self.spin)
        self.setFocusProxy(self.spin)

    def value(self) -> float:
        """What is shown: mm, degrees or a plain number."""
        quantity = self.node.unit in QUANTITIES
        return float(self.spin.property("rawValue")) if quantity else self.spin.value()

    def _told(self, *_) -> None:
        if not self._quiet:
            self.edited.emit(self.value())

    def show_value(self, value: object) -> None:
        self._quiet = True
        number = float(value) if isinstance(value, int | float) else 0.0
        if self.node.unit in QUANTITIES:
            self.spin.setProperty("rawValue", number)
        else:
            self.spin.setValue(number)
        self._quiet = False


class IntegerEditor(Editor):
    """A whole number."""

    def __init__(self, node: form.Node):
        super().__init__(node)
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

    def __init__(self, node: form.Node, names: list[str] | None = None):
        super().__init__(node)
        if names is None:
            self.box = None
            self.text = QtGui.QLineEdit()
            self.line.addWidget(self.text)
            self.setFocusProxy(self.text)
        else:
            self.box = calm(QtGui.QComboBox())
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

    def __init__(self, node: form.Node):
        super().__init__(node)
        self.box = calm(QtGui.QComboBox())
        for k, (word, told) in enumerate(node.words.items()):
            self.box.addItem(form.title(word), word)
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

    def __init__(self, node: form.Node):
        super().__init__(node)
        self.box = QtGui.QCheckBox()
        self.box.toggled.connect(self.edited.emit)
        self.line.addWidget(self.box)

    def show_value(self, value: object) -> None:
        self.box.blockSignals(True)
        self.box.setChecked(bool(value))
        self.box.blockSignals(False)


class RowEditor(Editor):
    """A fixed number of values beside each other."""

    def __init__(self, node: form.Node, names: list[str] | None = None):
        super().__init__(node)
        self._value: list = []
        self.cells = []
        for k in range(node.columns):
            if node.kind == "words":
                cell = TextEditor(node, names)
            elif node.item is not None and node.item.kind == "integer":
                cell = IntegerEditor(node.item)
            else:
                cell = NumberEditor(node)
            cell.edited.connect(lambda value, k=k: self._told(k, value))
            self.line.addWidget(cell)
            self.cells.append(cell)
        self.setFocusProxy(self.cells[0])

    def _told(self, k: int, value: object) -> None:
        self._value = [*self._value[:k], value, *self._value[k + 1 :]]
        self.edited.emit(list(self._value))

    def show_value(self, value: object) -> None:
        self._value = list(value) if isinstance(value, list) else []
        filler = "" if self.node.kind == "words" else 0.0
        self._value += [filler] * (self.node.columns - len(self._value))
        for cell, part in zip(self.cells, self._value, strict=False):
            cell.show_value(part)


class RawEditor(Editor):
    """Anything else: shown by its size, edited as JSON."""

    def __init__(self, node: form.Node):
        super().__init__(node)
        self._value: object = None
        self.size = QtGui.QLabel()
        self.button = QtGui.QPushButton("Edit...")
        self.button.clicked.connect(self._edit)
        self.line.addWidget(self.size, 1)
        self.line.addWidget(self.button)

    def show_value(self, value: object) -> None:
        self._value = value
        self.size.setText(f"{len(value)} entries" if isinstance(value, list) else "")

    def _edit(self) -> None:
        before = json.dumps(self._value, indent=1)
        text, done = QtGui.QInputDialog.getMultiLineText(self, self.node.title, self.node.help, before)
        if done:
            try:
                self._value = json.loads(text)
            except ValueError as error:
                QtGui.QMessageBox.warning(self, self.node.title, str(error))
            else:
                self.show_value(self._value)
                self.edited.emit(self._value)
