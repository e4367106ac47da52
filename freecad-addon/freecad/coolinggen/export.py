"""A dialog for the sidecar's files."""

from pathlib import Path

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from . import blade, job, waiting
from .client.formats import FORMATS


class Dialog(QtGui.QDialog):
    """Asks for formats and a folder."""

    def __init__(self, obj):
        super().__init__(Gui.getMainWindow())
        self.setObjectName("CoolingGenExport")
        self.setWindowTitle(f"Export {obj.Label}")
        form = QtGui.QFormLayout(self)
        self.formats = {}
        for name, (title, purpose) in FORMATS.items():
            box = QtGui.QCheckBox(title)
            box.setObjectName(f"format:{name}")
            box.setToolTip(purpose)
            box.setChecked(name == "step")
            form.addRow("Formats" if not self.formats else "", box)
            self.formats[name] = box
        beside = Path(obj.Document.FileName).parent if obj.Document.FileName else Path.home()
        line = QtGui.QHBoxLayout()
        self.folder = QtGui.QLineEdit(str(beside))
        self.folder.setObjectName("folder")
        browse = QtGui.QPushButton("...")
        browse.clicked.connect(self._browse)
        line.addWidget(self.folder)
        line.addWidget(browse)
        form.addRow("Folder", line)
        buttons = QtGui.QDialogButtonBox(QtGui.QDialogButtonBox.Ok | QtGui.QDialogButtonBox.Cancel)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        form.addRow(buttons)

    def _browse(self) -> None:
        path = QtGui.QFileDialog.getExistingDirectory(self, "Folder", self.folder.text())
        if path:
            self.folder.setText(path)


def ask(obj) -> None:
    """Asks, and writes the files."""
    dialog = Dialog(obj)
    if not dialog.exec_():
        return
    kinds = [name for name, box in dialog.formats.items() if box.isChecked()]
    if kinds:
        write(obj, Path(dialog.folder.text()), kinds)


def write(obj, folder: Path, kinds: list[str]) -> list[Path]:
    """Writes a blade's solids into ``folder``, in the design's coordinates; the paths."""
    wanted = blade.request(obj)
    paths = waiting.run("Export", lambda watch: job.export(wanted, folder, kinds, watch))
    App.Console.PrintMessage("".join(f"{path}\n" for path in paths))
    return paths
