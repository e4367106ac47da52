"""Loaded by FreeCAD's window: the workbench."""

from pathlib import Path

import FreeCADGui as Gui

ICONS = Path(__file__).parent / "icons"


class CoolingGenWorkbench(Gui.Workbench):
    """Cooled turbine blades."""

    MenuText = "CoolingGen"
    ToolTip = "Cooled turbine blades from one design"
    Icon = str(ICONS / "blade.svg")

    def Initialize(self) -> None:  # noqa: N802 (FreeCAD's name)
        from .commands import register

        commands = register()
        self.appendToolbar("CoolingGen", commands)
        self.appendMenu("CoolingGen", commands)

    def GetClassName(self) -> str:  # noqa: N802 (FreeCAD's name)
        return "Gui::PythonWorkbench"


def _preferences() -> None:
    from .preferences import Page

    Gui.addIconPath(str(ICONS))
    Gui.addPreferencePage(Page, "CoolingGen")


Gui.addWorkbench(CoolingGenWorkbench())
_preferences()
