"""The preferences page: where the sidecar is, and whether it answers."""

import FreeCAD as App
from PySide import QtGui

from . import service
from .client.sidecar import SidecarError, find


class Page:
    """FreeCAD makes it, shows ``form``, and has it load and save."""

    def __init__(self, parent=None):
        self.form = QtGui.QWidget()
        self.form.setWindowTitle("CoolingGen")
        box = QtGui.QVBoxLayout(self.form)
        group = QtGui.QGroupBox("The program that builds the blades")
        box.addWidget(group)
        box.addStretch(1)
        lines = QtGui.QVBoxLayout(group)
        told = QtGui.QLabel(
            "Path of <b>coolinggen</b>. Left empty, the one that came with the add-on is used, "
            "or else the one on the PATH."
        )
        told.setWordWrap(True)
        lines.addWidget(told)
        line = QtGui.QHBoxLayout()
        lines.addLayout(line)
        self.path = QtGui.QLineEdit()
        self.path.setObjectName("CoolingGenPath")
        self.path.setPlaceholderText("found by itself")
        self.browse = QtGui.QPushButton("...")
        self.browse.clicked.connect(self._browse)
        self.test = QtGui.QPushButton("Test")
        self.test.setObjectName("CoolingGenTest")
        self.test.clicked.connect(self._test)
        for widget in (self.path, self.browse, self.test):
            line.addWidget(widget)
        self.answer = QtGui.QLabel()
        self.answer.setObjectName("CoolingGenAnswer")
        self.answer.setWordWrap(True)
        lines.addWidget(self.answer)

    def loadSettings(self) -> None:  # noqa: N802 (FreeCAD's name)
        self.path.setText(service.preferred())

    def saveSettings(self) -> None:  # noqa: N802 (FreeCAD's name)
        path = self.path.text().strip()
        if path != service.preferred():
            App.ParamGet(service.PREFERENCES).SetString("Binary", path)
            # The next blade is built by what is preferred now.
            service.stop()

    def _browse(self) -> None:
        path, _ = QtGui.QFileDialog.getOpenFileName(self.form, "coolinggen")
        if path:
            self.path.setText(path)

    def _test(self) -> None:
        path = self.path.text().strip()
        try:
            server = service.start(path)
        except SidecarError as error:
            self._say(str(error), "#c0392b")
            return
        known = server.server["server"]
        server.close()
        protocol = server.server["protocol_version"]
        self._say(f"{known['name']} {known['version']}, protocol {protocol}: {find(path)}", "#1e8449")

    def _say(self, text: str, color: str) -> None:
        self.answer.setText(text)
        self.answer.setStyleSheet(f"color: {color};")
