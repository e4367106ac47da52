"""A field in a form: its label, its widget, and what is wrong with it."""

from dataclasses import replace

from PySide import QtCore, QtGui

from ..client import forms, paths
from . import simple
from .context import Context
from .law import LawEditor, TableEditor

WRONG = "color: #c0392b;"


def optional(field: forms.Field) -> bool:
    """Whether a design may do without the field, with nothing in its place."""
    return not field.required and field.default is None and not isinstance(field.shape, forms.List)


def blank(field: forms.Field) -> object:
    """What a field begins with."""
    return forms.blank(field.shape, field.default)


def help_text(field: forms.Field) -> str:
    """What a tooltip says: what the field is, its unit, limits and default."""
    facts = []
    if field.unit:
        facts.append(f"Unit: {field.unit}")
    low, high = getattr(field.shape, "minimum", None), getattr(field.shape, "maximum", None)
    if low is not None and high is not None:
        facts.append(f"Range: {low:g} to {high:g}")
    if isinstance(field.default, int | float | str) and not isinstance(field.default, bool):
        facts.append(f"Default: {field.default}")
    return f"<p>{field.description}</p><p>{'<br>'.join(facts)}</p><p><i>{field.key}</i></p>"


def editor(field: forms.Field, context: Context) -> simple.Editor:
    """The widget of a field that holds no other fields."""
    names = (
        paths.names(context.design, paths.REFERENCES[field.key]) if field.key in paths.REFERENCES else None
    )
    match field.shape:
        case forms.Number(words=words) if words:
            return WordEditor(field, context)
        case forms.Number(integer=True):
            return simple.IntegerEditor()
        case forms.Number(maximum=high):
            return simple.NumberEditor(field.unit, fraction=high is not None and high <= 1)
        case forms.Law():
            return LawEditor(field.unit)
        case forms.Tuple(length=length, integer=True):
            return simple.RowEditor([simple.IntegerEditor() for _ in range(length)], 0)
        case forms.Tuple(length=length, maximum=high):
            fraction = high is not None and high <= 1
            cells = [simple.NumberEditor(field.unit, fraction=fraction) for _ in range(length)]
            return simple.RowEditor(cells, 0.0)
        case forms.List(item=forms.Text()) if names is not None:
            return simple.RowEditor([simple.TextEditor(names) for _ in range(2)], "")
        case forms.Table(columns=columns):
            return TableEditor(columns, field.unit)
        case forms.Choice():
            return simple.ChoiceEditor(field.shape)
        case forms.Flag():
            return simple.BooleanEditor()
        case forms.Text():
            return simple.TextEditor(names)
    return simple.RawEditor(field)


def large(field: forms.Field) -> bool:
    """Whether its widget wants the whole width."""
    return isinstance(field.shape, forms.Table | forms.Raw)


class WordEditor(simple.Editor):
    """A number, or a word that stands for one: ``auto``."""

    def __init__(self, field: forms.Field, context: Context):
        super().__init__()
        self.words = field.shape.words
        self.box = simple.narrow(simple.calm(QtGui.QComboBox()))
        self.box.addItems([*map(forms.title, self.words), "Value"])
        self.number = editor(replace(field, shape=replace(field.shape, words=())), context)
        self.box.currentIndexChanged.connect(self._switch)
        self.number.edited.connect(self.edited.emit)
        self.line.addWidget(self.box)
        self.line.addWidget(self.number)
        self.setFocusProxy(self.box)

    def show_value(self, value: object) -> None:
        word = isinstance(value, str)
        self.box.blockSignals(True)
        self.box.setCurrentIndex(self.words.index(value) if value in self.words else len(self.words))
        self.box.blockSignals(False)
        self.number.setVisible(not word)
        if not word:
            self.number.show_value(value)

    def _switch(self, k: int) -> None:
        value = self.words[k] if k < len(self.words) else 1.0
        self.show_value(value)
        self.edited.emit(value)


class Line(QtCore.QObject):
    """A line of a form: label (with a box to tick where the field may be left out), widget, message."""

    def __init__(self, field: forms.Field, path: paths.Path, context: Context, layout: QtGui.QFormLayout):
        super().__init__(layout)
        self.field, self.path, self._context = field, path, context
        value = context.get(path)
        there = value is not paths.MISSING and value is not None
        self.optional = optional(field)
        self.label = QtGui.QCheckBox(field.title) if self.optional else QtGui.QLabel(field.title)
        self.label.setObjectName(f"label:{paths.pointer(path)}")
        self.label.setToolTip(help_text(field))
        # Points to pass through have a table; a whole spline has none.
        spline = isinstance(field.shape, forms.Table) and isinstance(value, dict)
        self.editor = simple.RawEditor(field) if spline else editor(field, context)
        self.editor.setToolTip(help_text(field))
        self.editor.setObjectName(paths.pointer(path))
        self.editor.show_value(value if there else blank(field))
        self.editor.edited.connect(self._edited)
        if self.optional:
            self.label.setChecked(there)
            self.editor.setEnabled(there)
            self.label.toggled.connect(self._ticked)
        self.message = QtGui.QLabel()
        self.message.setStyleSheet(WRONG)
        self.message.setWordWrap(True)
        self.message.hide()
        if large(field):
            layout.addRow(self.label)
            layout.addRow(self.editor)
        else:
            layout.addRow(self.label, self.editor)
        layout.addRow(self.message)
        context.show(path, self)

    def _edited(self, value: object) -> None:
        if self.optional and not self.label.isChecked():
            return
        there = self._context.get(self.path) is not paths.MISSING
        if not there and not self.field.required and value == self.field.default:
            return
        self._context.put(self.path, value)

    def _ticked(self, there: bool) -> None:
        self.editor.setEnabled(there)
        if there:
            value = blank(self.field)
            self.editor.show_value(value)
            self._context.put(self.path, value)
        else:
            self._context.put(self.path, paths.MISSING)

    def mark(self, message: str) -> None:
        """Says what is wrong with the field; nothing is with an empty message."""
        self.message.setText(message)
        self.message.setVisible(bool(message))
        self.label.setStyleSheet(WRONG if message else "")

    def reveal(self, rest: paths.Path) -> QtGui.QWidget:
        """The widget to look at."""
        return self.editor
