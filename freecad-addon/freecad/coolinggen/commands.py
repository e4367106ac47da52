"""The workbench's commands."""

import FreeCAD as App
import FreeCADGui as Gui

from . import blade
from .client.sidecar import SidecarError
from .service import sidecar


class NewFromTemplate:
    """Puts the first template's blade into the document."""

    def GetResources(self) -> dict:  # noqa: N802 (FreeCAD's name)
        return {
            "MenuText": "New cooled blade",
            "ToolTip": "Put a cooled blade from a template into the document",
        }

    def IsActive(self) -> bool:  # noqa: N802 (FreeCAD's name)
        return True

    def Activated(self) -> None:  # noqa: N802 (FreeCAD's name)
        document = App.ActiveDocument or App.newDocument()
        document.openTransaction("New cooled blade")
        try:
            blade.new(document, sidecar().call("template/get")["design"])
        except SidecarError as error:
            document.abortTransaction()
            App.Console.PrintError(f"{error}\n")
        else:
            document.commitTransaction()
            Gui.SendMsgToActiveView("ViewFit")


def register() -> list[str]:
    """Makes the commands known; their names."""
    Gui.addCommand("CoolingGen_New", NewFromTemplate())
    return ["CoolingGen_New"]
