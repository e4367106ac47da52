"""A field in a form: its label, its widget, and what is wrong with it."""

from PySide import QtCore, QtGui

from ..client import form
from . import simple
from .context import Context
from .law import LawEditor, TableEditor

WRONG = "color: #c0392b;"


def help_text(node: form.Node) -> str:
    """What a tooltip says: what the field is, its unit, limits and default."""
    facts = []
    if node.unit:
        facts.append(f"Unit: {node.unit}")
    if node.minimum is not None or node.maximum is not None:
        low = "" if node.minimum is None else f"{node.minimum:g}"
        high = "" if node.maximum is None else f"{node.maximum:g}"
        facts.append(f"Range: {low} to {high}")
    if isinstance(node.default, int | float | str) and not isinstance(node.default, bool):
        facts.append(f"Default: {node.default}")
    return f"<p>{node.help}</p><p>{'<br>'.join(facts)}</p><p><i>{node.name}</i></p>"


def editor(node: form.Node, context: Context) -> simple.Editor:
    """The widget of a node that fits on a line."""
    names = form.names(context.design, form.REFERENCES[node.name]) if node.name in form.REFERENCES else None
    makers = {
        "number": lambda: simple.NumberEditor(node),
        "integer": lambda: simple.IntegerEditor(node),
        "text": lambda: simple.TextEditor(node, names),
        "choice": lambda: simple.ChoiceEditor(node),
        "boolean": lambda: simple.BooleanEditor(node),
        "row": lambda: simple.RowEditor(node),
        "words": lambda: simple.RowEditor(node, names),
        "law": lambda: LawEditor(node),
        "table": lambda: TableEditor(node),
        "either": lambda: EitherEditor(node, context),
    }
    return makers.get(node.kind, lambda: simple.RawEditor(node))()


class EitherEditor(simple.Editor):
    """A value of one of several types: ``auto`` or a length, points or a spline."""

    def __init__(self, node: form.Node, context: Context):
        super().__init__(node)
        self._context = context
        self._value: object = None
        self._shown: simple.Editor | None = None
        self.box = simple.calm(QtGui.QComboBox())
        for option in node.options:
            self.box.addItem(_label(option))
            self.box.setItemData(self.box.count() - 1, option.help, QtCore.Qt.ToolTipRole)
        self.box.currentIndexChanged.connect(self._switch)
        self.line.setDirection(QtGui.QBoxLayout.TopToBottom)
        self.line.addWidget(self.box)
        self.setFocusProxy(self.box)

    def show_value(self, value: object) -> None:
        self._value = value
        self.box.blockSignals(True)
        self.box.setCurrentIndex(form.variant(self.node, value))
        self.box.blockSignals(False)
        if self._shown is not None:
            self.line.removeWidget(self._shown)
            self._shown.hide()
            self._shown.deleteLater()
            self._shown = None
        option = self.node.options[self.box.currentIndex()]
        if option.kind == "choice" and len(option.words) == 1:
            return
        self._shown = editor(option, self._context)
        self._shown.show_value(value)
        self._shown.edited.connect(self._told)
        self.line.addWidget(self._shown)

    def _told(self, value: object) -> None:
        self._value = value
        self.edited.emit(value)

    def _switch(self, k: int) -> None:
        self.show_value(form.blank(self.node.options[k]))
        self._told(self._value)


def _label(option: form.Node) -> str:
    if option.kind == "choice" and len(option.words) == 1:
        return form.title(next(iter(option.words)))
    names = {"number": "Value", "table": "Points", "row": "Point", "object": "B-spline", "integer": "Index"}
    return names.get(option.kind, option.kind)


class Field(QtCore.QObject):
    """A line of a form: label (with a box to tick where the field may be left out), widget, message."""

    def __init__(self, node: form.Node, path: form.Path, context: Context, layout: QtGui.QFormLayout):
        super().__init__(layout)
        self.node, self.path, self._context = node, path, context
        value = context.get(path)
        there = value is not form.MISSING and value is not None
        self.optional = node.nullable
        self.label = QtGui.QCheckBox(node.title) if self.optional else QtGui.QLabel(node.title)
        self.label.setToolTip(help_text(node))
        self.editor = editor(node, context)
        self.editor.setToolTip(help_text(node))
        self.editor.setObjectName(form.pointer(path))
        self.editor.show_value(value if there else form.blank(node))
        self.editor.edited.connect(self._edited)
        if self.optional:
            self.label.setChecked(there)
            self.editor.setEnabled(there)
            self.label.toggled.connect(self._ticked)
        self.message = QtGui.QLabel()
        self.message.setStyleSheet(WRONG)
        self.message.setWordWrap(True)
        self.message.hide()
        if node.small and node.kind not in ("table", "raw"):
            layout.addRow(self.label, self.editor)
        else:
            layout.addRow(self.label)
            layout.addRow(self.editor)
        layout.addRow(self.message)
        context.show(path, self)

    def _edited(self, value: object) -> None:
        if self.optional and not self.label.isChecked():
            return
        there = self._context.get(self.path) is not form.MISSING
        if not there and not self.node.required and value == self.node.default:
            return
        self._context.put(self.path, value)

    def _ticked(self, there: bool) -> None:
        self.editor.setEnabled(there)
        if there:
            value = form.blank(self.node)
            self.editor.show_value(value)
            self._context.put(self.path, value)
        else:
            self._context.put(self.path, form.MISSING)

    def mark(self, message: str) -> None:
        """Says what is wrong with the field; nothing is with an empty message."""
        self.message.setText(message)
        self.message.setVisible(bool(message))
        self.label.setStyleSheet(WRONG if message else "")

    def reveal(self, rest: form.Path) -> QtGui.QWidget:
        """The widget to look at."""
        return self.editor
