"""How blades and their solids look in FreeCAD's window."""

from pathlib import Path

import FreeCADGui as Gui
from pivy import coin

from .proxy import Proxy

ICONS = Path(__file__).parent / "icons"


def icon(name: str) -> str:
    """Path of an icon."""
    return str(ICONS / f"{name}.svg")


class _View(Proxy):
    """What both kinds of view have in common."""

    def __init__(self, view):
        view.Proxy = self

    def attach(self, view) -> None:
        self.Object = view.Object


class BladeView(_View):
    """A blade: its solids below it in the tree; a double click edits the design."""

    def getIcon(self) -> str:  # noqa: N802 (FreeCAD's names here and below)
        return icon("blade")

    def attach(self, view) -> None:
        super().attach(view)
        # Nothing of its own is shown, but without a mode the tree would take it for hidden.
        view.addDisplayMode(coin.SoGroup(), "Solids")

    def getDisplayModes(self, view) -> list[str]:  # noqa: N802
        return ["Solids"]

    def getDefaultDisplayMode(self) -> str:  # noqa: N802
        return "Solids"

    def claimChildren(self) -> list:  # noqa: N802
        return list(self.Object.Solids)

    def onChanged(self, view, name: str) -> None:  # noqa: N802
        if name == "Visibility" and "Restore" not in view.Object.State:
            for child in view.Object.Solids:
                child.ViewObject.Visibility = view.Visibility and child.SolidName.split("/")[0] != "coolant"

    def onDelete(self, view, subelements) -> bool:  # noqa: N802
        """The solids go with their blade."""
        for child in view.Object.Solids:
            if len([p for p in child.InList if hasattr(p, "Solids")]) < 2:
                view.Object.Document.removeObject(child.Name)
        return True

    def setEdit(self, view, mode: int) -> bool:  # noqa: N802
        if mode != 0:
            return False
        from . import panel

        return panel.edit(view.Object)

    def unsetEdit(self, view, mode: int) -> bool:  # noqa: N802
        if mode == 0:
            Gui.Control.closeDialog()
        return True

    def doubleClicked(self, view) -> bool:  # noqa: N802
        Gui.getDocument(view.Object.Document.Name).setEdit(view.Object.Name, 0)
        return True

    def setupContextMenu(self, view, menu) -> None:  # noqa: N802
        for command in ("CoolingGen_Edit", "CoolingGen_Export", "CoolingGen_Report"):
            found = Gui.Command.get(command) if hasattr(Gui, "Command") else None
            text = found.getInfo()["menuText"] if found else command
            menu.addAction(text).triggered.connect(lambda *_, c=command: _run(view.Object, c))


class SolidView(_View):
    """A solid: every face in the colour of its region."""

    def getIcon(self) -> str:  # noqa: N802
        part = self.Object.SolidName.split("/")[0]
        return icon(part if part in ("metal", "coolant", "insert") else "metal")

    def updateData(self, obj, name: str) -> None:  # noqa: N802
        if name in ("FaceColors", "Shape"):
            paint(obj)

    def doubleClicked(self, view) -> bool:  # noqa: N802
        from .blade import blade_of

        owner = blade_of(view.Object)
        return owner is not None and owner.ViewObject.Proxy.doubleClicked(owner.ViewObject)


def _run(obj, command: str) -> None:
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(obj)
    Gui.runCommand(command)


def paint(obj, colors: list | None = None) -> None:
    """Colours the faces of a solid, by region if nothing else is asked for."""
    # Three parts each: what a fourth means, transparency or opacity, depends on FreeCAD's version.
    colors = [tuple(color[:3]) for color in (obj.FaceColors if colors is None else colors)]
    if colors and len(colors) == len(obj.Shape.Faces):
        obj.ViewObject.DiffuseColor = colors


def dress(obj) -> None:
    """Gives a blade or a solid its view."""
    from .blade import is_blade

    if is_blade(obj):
        BladeView(obj.ViewObject)
        obj.ViewObject.Visibility = True
        return
    SolidView(obj.ViewObject)
    obj.ViewObject.DisplayMode = "Flat Lines"
    obj.ViewObject.LineWidth = 1.0
    if obj.SolidName.split("/")[0] == "coolant":
        obj.ViewObject.Visibility = False
