"""A wait that the user can see and end: work beside the window behind a progress dialog."""

import time
from collections.abc import Callable
from typing import TypeVar

from PySide import QtCore, QtGui

from . import job
from .client.latest import Done, Latest, Watch

Result = TypeVar("Result")


def build(wanted: job.Request) -> job.Built:
    """``job.build`` for recomputes that FreeCAD itself asked for."""
    return run("Cooled blade", lambda watch: job.build(wanted, watch, beside=True))


def run(title: str, work: Callable[[Watch], Result]) -> Result:
    """Does ``work`` in another thread; the window stays alive behind a dialog with progress and a Cancel
    button.
    """
    dialog = QtGui.QProgressDialog(title, "Cancel", 0, 100)
    dialog.setObjectName("CoolingGenProgress")
    dialog.setWindowTitle("CoolingGen")
    dialog.setWindowModality(QtCore.Qt.ApplicationModal)
    dialog.setMinimumDuration(400)
    dialog.setAutoReset(False)
    worker = Latest()
    worker.submit(work)
    try:
        while True:
            for news in worker.news():
                if isinstance(news, Done):
                    if news.error is not None:
                        raise news.error
                    return news.result
                dialog.setLabelText(f"{title}: {news.stage}")
                dialog.setValue(int(100 * news.fraction))
            if dialog.wasCanceled():
                worker.cancel()
            QtGui.QApplication.processEvents(QtCore.QEventLoop.AllEvents, 20)
            time.sleep(0.01)
    finally:
        worker.close()
        dialog.close()
        dialog.deleteLater()
