"""The workbench's commands: each a line in ``COMMANDS``."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from . import actions, panel
from .blade import blade_of
from .client.sidecar import CancelledError, SidecarError
from .view import icon


def _chosen():
    """The blade that is selected, or the only one of the document."""
    for selected in Gui.Selection.getSelection():
        if found := blade_of(selected):
            return found
    blades = [obj for obj in App.ActiveDocument.Objects if blade_of(obj) is obj] if App.ActiveDocument else []
    return blades[0] if len(blades) == 1 else None


def _idle() -> bool:
    return panel.active is None and not Gui.Control.activeDialog()


def _with_blade() -> bool:
    return _idle() and _chosen() is not None


def _with_selection() -> bool:
    return _idle() and bool(Gui.Selection.getSelection())


@dataclass(frozen=True)
class Command:
    """A command of FreeCAD's."""

    text: str
    help: str
    picture: str
    run: Callable[[], None]
    active: Callable[[], bool] = _idle

    def GetResources(self) -> dict:  # noqa: N802 (FreeCAD's names here and below)
        return {"MenuText": self.text, "ToolTip": self.help, "Pixmap": icon(self.picture)}

    def IsActive(self) -> bool:  # noqa: N802
        return self.active()

    def Activated(self, *_) -> None:  # noqa: N802
        try:
            self.run()
        except CancelledError:
            App.Console.PrintMessage(f"{self.text}: cancelled\n")
        except (SidecarError, OSError, ValueError, RuntimeError) as error:
            App.Console.PrintError(f"{self.text}: {error}\n")
            QtGui.QMessageBox.warning(Gui.getMainWindow(), self.text, str(error))


def _document():
    return App.ActiveDocument or App.newDocument()


def _from_template() -> None:
    from .service import templates

    designs = {design["name"]: design for design in templates()}
    title, told = "New cooled blade", "Template:"
    name, chosen = QtGui.QInputDialog.getItem(Gui.getMainWindow(), title, told, list(designs), 0, False)
    if chosen:
        panel.open_new(_document(), designs[name])


def _from_medial() -> None:
    from .service import templates

    design = next(d for d in templates() if d["name"] == "medial-cooled")
    panel.open_new(_document(), {**design, "name": "blade"}).reveal("/blade/thickness")


def _from_design() -> None:
    path, _ = QtGui.QFileDialog.getOpenFileName(Gui.getMainWindow(), "Design", "", "Design (*.json)")
    if path:
        actions.open_design(_document(), Path(path))


def _from_step() -> None:
    path, _ = QtGui.QFileDialog.getOpenFileName(
        Gui.getMainWindow(), "Blade's surface", "", "STEP (*.step *.stp *.STEP *.STP)"
    )
    if path:
        actions.open_step(_document(), Path(path))


COMMANDS = {
    "New": Command(
        "New cooled blade...", "A cooled blade to start from, of a template", "new", _from_template
    ),
    "FromSelection": Command(
        "Cool the selected blade",
        "A cooled blade in the place of the selected faces or solid, whose B-spline surfaces it takes over",
        "from_selection",
        lambda: actions.from_selection(_document()),
        _with_selection,
    ),
    "FromStep": Command(
        "Cooled blade from a STEP file...",
        "A cooled blade from the B-spline surfaces of a STEP file",
        "from_step",
        _from_step,
    ),
    "FromMedial": Command(
        "Cooled blade from medial parameters",
        "A turbine blade from its angles and thickness along the medial surface, cooled",
        "from_medial",
        _from_medial,
    ),
    "FromDesign": Command(
        "Cooled blade from a design...", "A cooled blade from its JSON file", "from_design", _from_design
    ),
    "Edit": Command(
        "Edit the design", "Edit the blade's design with a live preview", "edit",
        lambda: actions.edit(_chosen()), _with_blade,
    ),
    "Rebuild": Command(
        "Build again", "Build the blade's solids again", "rebuild",
        lambda: actions.rebuild(_chosen()), _with_blade,
    ),
    "Report": Command(
        "Report", "Tables of passages, holes and solids; a line's faces are selected by a click", "report",
        lambda: actions.report(_chosen()), _with_blade,
    ),
    "SelectFaces": Command(
        "Select faces by name...", "Select all faces whose names fit a pattern", "select",
        lambda: actions.select_faces(_chosen()), _with_blade,
    ),
    "Groups": Command(
        "Groups of faces for FEM and CfdOF", "Named groups of faces for boundary conditions", "groups",
        lambda: actions.groups(_chosen()), _with_blade,
    ),
    "Thickness": Command(
        "Wall thickness", "Show the metal between passages and the outer surface as colours; again: no more",
        "thickness", lambda: actions.thickness(_chosen()), _with_blade,
    ),
    "Regions": Command(
        "Colours by region", "Colour every face by its region", "regions",
        lambda: actions.regions(_chosen()), _with_blade,
    ),
    "Export": Command(
        "Export...", "Write the blade's solids for CAD, meshers and solvers, with all names", "export",
        lambda: actions.export(_chosen()), _with_blade,
    ),
}  # fmt: skip

#: Commands by the toolbars and the parts of the menu.
LAYOUT = (
    ("New", "FromSelection", "FromStep", "FromMedial", "FromDesign"),
    ("Edit", "Rebuild", "Report", "SelectFaces", "Groups"),
    ("Thickness", "Regions", "Export"),
)


def register() -> list[str]:
    """Makes the commands known; their names, parted by ``Separator``."""
    for name, command in COMMANDS.items():
        Gui.addCommand(f"CoolingGen_{name}", command)
    named = [[f"CoolingGen_{name}" for name in part] for part in LAYOUT]
    return [name for part in named for name in (*part, "Separator")][:-1]
