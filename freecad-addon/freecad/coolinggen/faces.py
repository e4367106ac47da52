"""Faces by their names: selection by patterns, and groups for boundary conditions."""

import re
from collections.abc import Iterator
from fnmatch import fnmatchcase

import FreeCAD as App
from PySide import QtGui

from .proxy import Proxy


def matching(obj, pattern: str) -> Iterator[tuple[object, str]]:
    """Solids and faces (``Face12``) of a blade whose names fit ``pattern``.

    ``*`` stands for anything, and a path for all below it.
    """
    wanted = pattern.strip().rstrip("/")
    for child in obj.Solids:
        for k, name in enumerate(child.FaceNames):
            if fnmatchcase(name, wanted) or fnmatchcase(name, f"{wanted}/*"):
                yield child, f"Face{k + 1}"


def select(obj, pattern: str) -> int:
    """Selects these faces in the place of what is selected; their number."""
    import FreeCADGui as Gui

    Gui.Selection.clearSelection()
    found: dict = {}
    for child, face in matching(obj, pattern):
        found.setdefault(child, []).append(face)
    for child, names in found.items():
        Gui.Selection.addSelection(child, names)
    return sum(map(len, found.values()))


def name_of(child, face: str) -> str:
    """Name of a solid's face ``Face12``; empty if it has none."""
    k = int(face.removeprefix("Face")) - 1 if re.fullmatch(r"Face\d+", face) else -1
    return child.FaceNames[k] if 0 <= k < len(child.FaceNames) else ""


def ask(obj) -> None:
    """Asks for a pattern, with the names' first parts to choose from, and selects."""
    import FreeCADGui as Gui

    told = "Name or pattern (film/ss1, blade/*, */fillet_*):"
    title = "Select faces by name"
    text, done = QtGui.QInputDialog.getItem(Gui.getMainWindow(), title, told, regions(obj), 0, True)
    if done:
        count = select(obj, text)
        App.Console.PrintMessage(f"{count} faces are called {text}\n")


def regions(obj) -> list[str]:
    """What faces are asked for together: the groups, as in every file."""
    return sorted({group for child in obj.Solids for group in _groups(child)})


def _groups(child) -> list[str]:
    """The group of each face of a solid; the face's own name in a document from before there were groups,
    until the blade is built anew."""
    return getattr(child, "FaceGroups", None) or child.FaceNames


def groups(obj) -> object:
    """A group beside the blade with one feature for each group of faces of each solid.

    Their ``References`` are the faces, as boundary conditions of FEM and CfdOF take them; they follow the
    names when the design changes.
    """
    document = obj.Document
    group = next((o for o in obj.InList if isinstance(getattr(o, "Proxy", None), FaceGroups)), None)
    if group is None:
        group = document.addObject("App::DocumentObjectGroupPython", "FaceGroups")
        FaceGroups(group)
        group.Blade = obj
        group.Label = f"{obj.Label} faces"
    group.Proxy.execute(group)
    return group


class FaceGroups(Proxy):
    """A group whose members follow a blade's faces."""

    def __init__(self, obj):
        """Gives ``obj`` its properties."""
        obj.Proxy = self
        if "Blade" not in obj.PropertiesList:
            obj.addProperty(
                "App::PropertyLinkGlobal", "Blade", "CoolingGen", "The blade whose faces are grouped"
            )

    def execute(self, obj) -> None:
        """One member for each group of faces of each solid: the groups of the manifest."""
        known = {member.Label: member for member in obj.Group}
        members = []
        for child in obj.Blade.Solids:
            wanted: dict[str, list[str]] = {}
            for k, name in enumerate(_groups(child)):
                wanted.setdefault(name, []).append(f"Face{k + 1}")
            for name, names in wanted.items():
                label = f"{child.SolidName}: {name}"
                member = known.pop(label, None) or _member(obj, label)
                if member.References != (child, names):
                    member.References = (child, names)
                members.append(member)
        obj.Group = members
        for member in known.values():
            obj.Document.removeObject(member.Name)

    def onDocumentRestored(self, obj) -> None:  # noqa: N802 (FreeCAD's name)
        pass


def _member(group, label: str):
    member = group.Document.addObject("App::FeaturePython", "FaceGroup")
    member.addProperty("App::PropertyLinkSubGlobal", "References", "CoolingGen", "The faces")
    member.Label = label
    if App.GuiUp:
        member.ViewObject.Proxy = 0
    return member
