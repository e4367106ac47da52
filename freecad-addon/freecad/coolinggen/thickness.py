"""Wall thickness as colours on the passages, seen through the metal, with a scale beside the view."""

import math

import FreeCADGui as Gui
from pivy import coin
from PySide import QtCore, QtGui

from . import blade, job, waiting
from .client.mesh import Mesh
from .client.thickness import SCALE, color, span
from .preview import mesh_node

TRANSPARENCY = 75  #: Of the metal, percent.

_shown: dict[str, "Shown"] = {}


class Shown:
    """A blade's wall thickness in its document's view; ``clear`` takes it away."""

    def __init__(self, obj, meshes: list[Mesh]):
        self.range = span(sorted(w for mesh in meshes for w in mesh.wall_thickness if math.isfinite(w)))
        self._root = Gui.getDocument(obj.Document.Name).ActiveView.getSceneGraph()
        self._node = coin.SoSeparator()
        self._node.setName("CoolingGenThickness")
        place, base = coin.SoTransform(), obj.Placement.Base
        place.translation.setValue(base.x, base.y, base.z)
        place.rotation.setValue(*obj.Placement.Rotation.Q)
        self._node.addChild(place)
        for mesh in meshes:
            colors = [color(value, *self.range) for value in mesh.wall_thickness]
            self._node.addChild(mesh_node(mesh, by_vertex=colors))
        self._root.addChild(self._node)
        self._metal = [c for c in obj.Solids if c.SolidName.split("/")[0] == "metal"]
        self._before = [c.ViewObject.Transparency for c in self._metal]
        for child in self._metal:
            child.ViewObject.Transparency = TRANSPARENCY
        self._scale = scale(*self.range)

    def clear(self) -> None:
        """The view as it was."""
        self._root.removeChild(self._node)
        for child, before in zip(self._metal, self._before, strict=True):
            child.ViewObject.Transparency = before
        self._scale.close()
        self._scale.deleteLater()


def toggle(obj) -> Shown | None:
    """Shows a blade's wall thickness, or takes it away; what is shown now."""
    key = f"{obj.Document.Name}.{obj.Name}"
    if key in _shown:
        _shown.pop(key).clear()
        return None
    wanted = blade.request(obj)
    meshes = waiting.run("Wall thickness", lambda watch: job.wall_thickness(wanted, watch))
    _shown[key] = Shown(obj, meshes)
    return _shown[key]


def scale(low: float, high: float) -> QtGui.QDockWidget:
    """A window's part that says which colour means which thickness."""
    window = Gui.getMainWindow()
    dock = QtGui.QDockWidget("Wall thickness", window)
    dock.setObjectName("CoolingGenThickness")
    widget = QtGui.QWidget()
    line = QtGui.QHBoxLayout(widget)
    stops = ", ".join(
        f"stop:{k / (len(SCALE) - 1)} rgb({', '.join(str(int(255 * part)) for part in c)})"
        for k, c in enumerate(SCALE)
    )
    bar = QtGui.QLabel()
    bar.setMinimumSize(160, 16)
    bar.setStyleSheet(f"background: qlineargradient(x1:0, y1:0, x2:1, y2:0, {stops});")
    line.addWidget(QtGui.QLabel(f"{low:.3f} mm"))
    line.addWidget(bar, 1)
    line.addWidget(QtGui.QLabel(f"{high:.3f} mm and more"))
    dock.setWidget(widget)
    dock.setMaximumHeight(70)
    window.addDockWidget(QtCore.Qt.TopDockWidgetArea, dock)
    return dock
