"""What the commands do, apart from asking for files."""

import json
from pathlib import Path

import FreeCADGui as Gui

from . import blade, panel
from .client.sidecar import SidecarError


def edit(obj) -> None:
    """Opens the task panel of a blade."""
    Gui.getDocument(obj.Document.Name).setEdit(obj.Name, 0)


def rebuild(obj) -> None:
    """Builds a blade's solids again."""
    obj.Document.openTransaction("Build again")
    blade.rebuild(obj)
    obj.Document.commitTransaction()


def open_design(document, path: Path) -> panel.Panel:
    """A panel for a new blade from a design's file."""
    design = json.loads(path.read_text(encoding="utf-8"))
    source = design.get("blade", {}) if isinstance(design, dict) else {}
    file = str(path.parent / source["file"]) if source.get("kind") == "step" and "file" in source else ""
    return panel.open_new(document, design, file=file)


def open_step(document, path: Path) -> panel.Panel:
    """A panel for a new blade from the surfaces of a STEP file; FreeCAD reads it, too, to see where it is."""
    import Part

    from . import source

    found = source.of_faces(Part.read(str(path)).Faces)
    return panel.open_new(document, source.design(path.stem, found, file=str(path)), file=str(path))


def from_selection(document) -> panel.Panel:
    """A panel for a new blade in the place of what is selected."""
    from . import source

    chosen = source.selected()
    made = panel.open_new(document, chosen.design, file=chosen.file, placement=chosen.placement)
    made.replaces(chosen.drawn)
    return made


def report(obj) -> None:
    """Shows a blade's tables."""
    from . import report_view

    report_view.show(obj)


def select_faces(obj) -> None:
    """Asks for a pattern and selects the faces whose names fit."""
    from . import faces

    faces.ask(obj)


def groups(obj) -> None:
    """Makes groups of faces by their regions."""
    from . import faces

    obj.Document.openTransaction("Groups of faces")
    faces.groups(obj)
    obj.Document.recompute()
    obj.Document.commitTransaction()


def thickness(obj) -> None:
    """Shows a blade's wall thickness, or takes it away."""
    from . import thickness as shown

    shown.toggle(obj)


def regions(obj) -> None:
    """Colours a blade's faces by region."""
    from .view import paint

    for child in obj.Solids:
        paint(child)


def export(obj) -> None:
    """Asks for formats and a folder, and writes the blade's files."""
    from . import export as dialog

    if not obj.Design:
        raise SidecarError(f"{obj.Label} has no design")
    dialog.ask(obj)
