"""CoolingGen for Blender: cooled turbine blades that follow their designs, built by ``coolinggen``."""

from . import handlers, live, operators, panels, preferences, service, settings

_PARTS = (preferences, settings, operators, panels, handlers)


def register() -> None:
    """Makes the add-on known to Blender."""
    for part in _PARTS:
        part.register()


def unregister() -> None:
    """Takes it away."""
    live.stop()
    service.stop()
    for part in reversed(_PARTS):
        part.unregister()
