"""Loaded by FreeCAD's window: the workbench."""

import FreeCADGui as Gui


class CoolingGenWorkbench(Gui.Workbench):
    """Cooled turbine blades."""

    MenuText = "CoolingGen"
    ToolTip = "Cooled turbine blades from one design"

    def Initialize(self) -> None:  # noqa: N802 (FreeCAD's name)
        from .commands import register

        commands = register()
        self.appendToolbar("CoolingGen", commands)
        self.appendMenu("CoolingGen", commands)

    def GetClassName(self) -> str:  # noqa: N802 (FreeCAD's name)
        return "Gui::PythonWorkbench"


Gui.addWorkbench(CoolingGenWorkbench())
