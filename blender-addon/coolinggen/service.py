"""The one sidecar of this Blender, started when it is first needed and again when it has died."""

import threading

import bpy

from .client.sidecar import Sidecar, find

_sidecar: Sidecar | None = None
_lock = threading.Lock()


def preferred() -> str:
    """The sidecar that the preferences name, if they do."""
    addon = bpy.context.preferences.addons.get(__package__)
    return bpy.path.abspath(addon.preferences.binary) if addon and addon.preferences.binary else ""


def sidecar(preferred: str) -> Sidecar:
    """The running sidecar; ``preferred`` where one must be started. Any thread may ask."""
    global _sidecar
    with _lock:
        if _sidecar is None or not _sidecar.alive:
            _sidecar = Sidecar(find(preferred), f"Blender {bpy.app.version_string}")
        return _sidecar


def stop() -> None:
    """Ends the sidecar, if there is one."""
    global _sidecar
    with _lock:
        if _sidecar is not None:
            _sidecar.close()
            _sidecar = None
