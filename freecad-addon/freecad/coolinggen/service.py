"""The one sidecar of this FreeCAD, started when it is first needed and again when it has died."""

import atexit

import FreeCAD as App

from .client.sidecar import Sidecar, find

PREFERENCES = "User parameter:BaseApp/Preferences/Mod/CoolingGen"

_sidecar: Sidecar | None = None


def sidecar() -> Sidecar:
    """The running sidecar."""
    global _sidecar
    if _sidecar is None or not _sidecar.alive:
        preferred = App.ParamGet(PREFERENCES).GetString("Binary", "")
        _sidecar = Sidecar(find(preferred), f"FreeCAD {'.'.join(App.Version()[:3])}")
    return _sidecar


@atexit.register
def stop() -> None:
    """Ends the sidecar, if there is one."""
    global _sidecar
    if _sidecar is not None:
        _sidecar.close()
        _sidecar = None
