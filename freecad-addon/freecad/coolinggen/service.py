"""The one sidecar of this FreeCAD, started when it is first needed and again when it has died."""

import atexit
import functools
import threading

import FreeCAD as App

from .client.sidecar import Sidecar, find

PREFERENCES = "User parameter:BaseApp/Preferences/Mod/CoolingGen"

_sidecar: Sidecar | None = None
_starting = threading.Lock()


def preferred() -> str:
    """Path of the sidecar that the user prefers; empty if none is."""
    return App.ParamGet(PREFERENCES).GetString("Binary", "")


def start(binary: str) -> Sidecar:
    """Starts the sidecar that is preferred, or else found."""
    return Sidecar(find(binary), f"FreeCAD {'.'.join(App.Version()[:3])}")


def sidecar() -> Sidecar:
    """The running sidecar; may be asked for from any thread."""
    global _sidecar
    with _starting:
        if _sidecar is None or not _sidecar.alive:
            _sidecar = start(preferred())
        return _sidecar


@functools.cache
def schema() -> dict:
    """The JSON Schema of a design."""
    return sidecar().call("schema/get")["schema"]


@functools.cache
def templates() -> list[dict]:
    """All designs to start from."""
    names = sidecar().call("template/get")["names"]
    return [sidecar().call("template/get", name=name)["design"] for name in names]


@atexit.register
def stop() -> None:
    """Ends the sidecar, if there is one."""
    global _sidecar
    if _sidecar is not None:
        _sidecar.close()
        _sidecar = None
