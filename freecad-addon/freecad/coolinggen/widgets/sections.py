"""Objects, lists and variants of a form, and the sections of its first level."""

from copy import deepcopy
from dataclasses import replace

from PySide import QtCore, QtGui

from ..client import forms, paths
from .context import Context
from .rows import WRONG, Line, blank, help_text, optional
from .simple import calm


def fill(group: forms.Group, path: paths.Path, context: Context, layout: QtGui.QFormLayout) -> None:
    """Puts an object's fields into a form."""
    for field in group.fields:
        add(field, (*path, field.key), context, layout)


def add(field: forms.Field, path: paths.Path, context: Context, layout: QtGui.QFormLayout) -> None:
    """Puts a field into a form, with all that is in it."""
    match field.shape:
        case forms.Group():
            layout.addRow(GroupPart(field, path, context))
        case forms.Variants():
            layout.addRow(VariantsPart(field, path, context))
        case forms.List(item=forms.Group() | forms.Variants()):
            layout.addRow(ListPart(field, path, context))
        case _:
            Line(field, path, context, layout)


def simple(field: forms.Field) -> bool:
    """Whether a field holds no other fields."""
    item = field.shape.item if isinstance(field.shape, forms.List) else field.shape
    return not isinstance(item, forms.Group | forms.Variants)


def form_layout(widget: QtGui.QWidget) -> QtGui.QFormLayout:
    """A form that suits the narrow panel."""
    layout = QtGui.QFormLayout(widget)
    layout.setContentsMargins(4, 2, 2, 2)
    layout.setVerticalSpacing(3)
    layout.setHorizontalSpacing(6)
    layout.setFieldGrowthPolicy(QtGui.QFormLayout.AllNonFixedFieldsGrow)
    return layout


class Part(QtGui.QWidget):
    """Something of a form with a heading and a body that is made anew when the design's value changes as
    a whole.
    """

    def __init__(self, field: forms.Field, path: paths.Path, context: Context, *, heading: bool = True):
        super().__init__()
        self.field, self.path, self.context = field, path, context
        self.box = QtGui.QVBoxLayout(self)
        self.box.setContentsMargins(0, 2, 0, 2)
        self.box.setSpacing(2)
        self.head = QtGui.QHBoxLayout()
        self.box.addLayout(self.head)
        self.message = QtGui.QLabel()
        self.message.setStyleSheet(WRONG)
        self.message.setWordWrap(True)
        self.message.hide()
        self.box.addWidget(self.message)
        self.body: QtGui.QWidget | None = None
        self.tick: QtGui.QCheckBox | None = None
        if heading and optional(field):
            self.tick = QtGui.QCheckBox(field.title)
            self.tick.setToolTip(help_text(field))
            self.tick.setChecked(isinstance(context.get(path, None), dict | list))
            self.tick.toggled.connect(self._ticked)
            self.head.addWidget(self.tick)
        elif heading:
            label = QtGui.QLabel(f"<b>{field.title}</b>")
            label.setToolTip(help_text(field))
            self.head.addWidget(label)
        context.show(path, self)

    @property
    def there(self) -> bool:
        """Whether the design has it."""
        return self.tick is None or self.tick.isChecked()

    def _ticked(self, there: bool) -> None:
        self.context.put(self.path, blank(self.field) if there else paths.MISSING)
        self.rebuild()

    def rebuild(self) -> None:
        """Makes the body from the design as it is."""
        if self.body is not None:
            self.box.removeWidget(self.body)
            self.body.hide()
            self.body.deleteLater()
            self.body = None
            self.context.forget(self.path)
            self.context.show(self.path, self)
        if self.there:
            self.body = QtGui.QWidget()
            self.build(form_layout(self.body))
            self.box.addWidget(self.body)

    def build(self, layout: QtGui.QFormLayout) -> None:
        """Fills the body."""
        raise NotImplementedError

    def mark(self, message: str) -> None:
        """Says what is wrong with it as a whole."""
        self.message.setText(message)
        self.message.setVisible(bool(message))

    def reveal(self, rest: paths.Path) -> QtGui.QWidget:
        """Shows what is at the path ``rest`` inside, as far as it can, and says which widget that is."""
        return self


class GroupPart(Part):
    """An object: its fields."""

    def __init__(self, field: forms.Field, path: paths.Path, context: Context, *, heading: bool = True):
        super().__init__(field, path, context, heading=heading)
        self.rebuild()

    def build(self, layout: QtGui.QFormLayout) -> None:
        fill(self.field.shape, self.path, self.context, layout)


class VariantsPart(Part):
    """An object of one of several kinds: a box to choose the kind, and its fields."""

    def __init__(self, field: forms.Field, path: paths.Path, context: Context, *, heading: bool = True):
        super().__init__(field, path, context, heading=heading)
        self.kinds = calm(QtGui.QComboBox())
        self.kinds.setObjectName(paths.pointer((*path, field.shape.tag)))
        for k, (word, told, _) in enumerate(field.shape.options):
            self.kinds.addItem(forms.title(word))
            self.kinds.setItemData(k, told, QtCore.Qt.ToolTipRole)
        self.kinds.setCurrentIndex(self._kind())
        self.kinds.currentIndexChanged.connect(self._switch)
        self.head.addWidget(self.kinds, 1)
        self.rebuild()

    def _kind(self) -> int:
        """Which of the kinds the design's value is of."""
        value = self.context.get(self.path, self.field.default)
        word = value.get(self.field.shape.tag) if isinstance(value, dict) else None
        words = [option[0] for option in self.field.shape.options]
        return words.index(word) if word in words else 0

    def _switch(self, k: int) -> None:
        """Another kind: fields that it shares with the one before keep their values."""
        word, _, group = self.field.shape.options[k]
        before = self.context.get(self.path, {})
        kept = {f.key: before[f.key] for f in group.fields if f.key in before}
        self.context.put(self.path, {self.field.shape.tag: word, **forms.blank(group), **kept})
        self.rebuild()

    def build(self, layout: QtGui.QFormLayout) -> None:
        fill(self.field.shape.options[self.kinds.currentIndex()][2], self.path, self.context, layout)


class ListPart(Part):
    """A list of objects: which one is shown, buttons to add, duplicate and remove, and its fields."""

    def __init__(self, field: forms.Field, path: paths.Path, context: Context, *, heading: bool = True):
        super().__init__(field, path, context, heading=heading)
        self.items = calm(QtGui.QComboBox())
        self.items.setObjectName(paths.pointer(path))
        self.items.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLength)
        self.head.addWidget(self.items, 1)
        self.buttons = {}
        for name, text, told in (
            ("add", "+", "Add another"),
            ("duplicate", "2\u00d7", "Duplicate this one"),
            ("remove", "\u2212", "Remove this one"),
        ):
            button = QtGui.QToolButton()
            button.setText(text)
            button.setToolTip(told)
            button.setObjectName(f"{paths.pointer(path)}:{name}")
            button.clicked.connect(getattr(self, name))
            self.head.addWidget(button)
            self.buttons[name] = button
        self.items.currentIndexChanged.connect(lambda *_: self.rebuild())
        self.refresh(0)

    def _values(self) -> list:
        found = self.context.get(self.path, [])
        return found if isinstance(found, list) else []

    def refresh(self, k: int) -> None:
        """Lists the items anew and shows the k-th."""
        values = self._values()
        self.items.blockSignals(True)
        self.items.clear()
        for i, value in enumerate(values):
            self.items.addItem(self._name(i, value))
        self.items.setCurrentIndex(min(k, len(values) - 1))
        self.items.blockSignals(False)
        self.buttons["add"].setEnabled((most := self.field.shape.maximum) is None or len(values) < most)
        for name in ("duplicate", "remove"):
            self.buttons[name].setEnabled(bool(values))
        self.rebuild()

    def _name(self, k: int, value: object) -> str:
        known = value if isinstance(value, dict) else {}
        for key in ("name", "chamber", "span", "z", "v", "radius_r"):
            if isinstance(known.get(key), str | int | float):
                return known[key] if isinstance(known[key], str) else f"{key} {known[key]:g}"
        return str(k + 1)

    def _names(self) -> tuple[str, ...]:
        return tuple(v["name"] for v in self._values() if isinstance(v, dict) and "name" in v)

    def _insert(self, k: int, value: dict) -> None:
        if "name" in value:
            value["name"] = paths.unused(self._names(), value["name"] or "new")
        values = list(self._values())
        values.insert(k, value)
        self.context.put(self.path, values)
        self.refresh(k)

    def add(self, *_) -> None:
        """Adds an item as the samples have it, or a plain one."""
        made = paths.example(self.context.examples, self.path)
        if made is paths.MISSING:
            made = forms.blank(self.field.shape.item)
        for key, of in paths.REFERENCES.items():
            there = paths.names(self.context.design, of)
            if isinstance(made.get(key), str) and made[key] not in there and there:
                made[key] = there[0]
        self._insert(len(self._values()), made)

    def duplicate(self, *_) -> None:
        """Puts a copy of the item shown behind it."""
        k = self.items.currentIndex()
        self._insert(k + 1, deepcopy(self._values()[k]))

    def remove(self, *_) -> None:
        """Removes the item shown."""
        k = self.items.currentIndex()
        values = list(self._values())
        del values[k]
        self.context.put(self.path, values if values or self.field.required else paths.MISSING)
        self.refresh(k)

    def build(self, layout: QtGui.QFormLayout) -> None:
        k = self.items.currentIndex()
        if k < 0:
            return
        item, path = self.field.shape.item, (*self.path, k)
        if isinstance(item, forms.Variants):
            field = replace(self.field, shape=item)
            layout.addRow(VariantsPart(field, path, self.context, heading=False))
        else:
            fill(item, path, self.context, layout)

    def reveal(self, rest: paths.Path) -> QtGui.QWidget:
        if rest and isinstance(rest[0], int) and rest[0] < self.items.count():
            self.items.setCurrentIndex(rest[0])
        return self


class Section(QtGui.QWidget):
    """A collapsible part of the panel; its body is made when it is first opened."""

    def __init__(self, title: str, told: str, paths: list[paths.Path], context: Context, make):
        super().__init__()
        self.paths, self._context, self._make = paths, context, make
        box = QtGui.QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.setSpacing(0)
        self.button = QtGui.QToolButton()
        self.button.setText(title)
        self.button.setObjectName(f"section:{title}")
        self.button.setToolTip(told)
        self.button.setCheckable(True)
        self.button.setToolButtonStyle(QtCore.Qt.ToolButtonTextBesideIcon)
        self.button.setArrowType(QtCore.Qt.RightArrow)
        self.button.setSizePolicy(QtGui.QSizePolicy.Expanding, QtGui.QSizePolicy.Fixed)
        self.button.setStyleSheet("QToolButton { font-weight: bold; text-align: left; padding: 3px; }")
        self.button.toggled.connect(self._toggled)
        box.addWidget(self.button)
        self.body: QtGui.QWidget | None = None
        for path in paths:
            context.show(path, self)

    def _toggled(self, wanted: bool) -> None:
        self.button.setArrowType(QtCore.Qt.DownArrow if wanted else QtCore.Qt.RightArrow)
        if wanted and self.body is None:
            self.body = QtGui.QWidget()
            self._make(form_layout(self.body))
            self.layout().addWidget(self.body)
        if self.body is not None:
            self.body.setVisible(wanted)

    def mark(self, message: str) -> None:
        """Says that something inside is wrong."""
        self.warn(bool(message))

    def warn(self, wrong: bool) -> None:
        """Colours the heading."""
        color = " color: #c0392b;" if wrong else ""
        self.button.setStyleSheet(
            f"QToolButton {{ font-weight: bold; text-align: left; padding: 3px;{color} }}"
        )

    def reveal(self, rest: paths.Path) -> QtGui.QWidget:
        """Opens it."""
        self.button.setChecked(True)
        return self
