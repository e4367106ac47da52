"""Designs into meshes. Nothing here touches Blender's data, so that it can run beside the window."""

from collections.abc import Callable
from dataclasses import dataclass

from .client.latest import Watch
from .client.sidecar import RefusedError, Sidecar
from .meshes import Arrays, arrays


@dataclass(frozen=True)
class Order:
    """What is to be built."""

    model: str
    """The model's name with the sidecar."""
    design: dict
    folder: str
    """Where relative paths in the design begin; may be empty."""
    chord_mm: float
    angle_deg: float


@dataclass(frozen=True)
class Built:
    """What became of it."""

    order: Order
    solids: list[Arrays]
    report: dict


def build(order: Order, connect: Callable[[], Sidecar], watch: Watch) -> Built:
    """The meshes of a design.

    Raises what the sidecar answers; the pointers of a refusal are relative to the design.
    """
    watched = {"progress": watch.progress, "cancelled": watch.stopped}
    folder = {"folder": order.folder} if order.folder else {}
    server = connect()
    try:
        made = server.call("design/generate", model=order.model, design=order.design, **folder, **watched)
    except RefusedError as refused:
        faults = [{**fault, "pointer": fault["pointer"].removeprefix("/design")} for fault in refused.faults]
        raise RefusedError(str(refused), faults) from refused
    tolerances = {"chord_mm": order.chord_mm, "angle_deg": order.angle_deg}
    meshes = server.call("model/tessellate", model=order.model, **tolerances, **watched)
    return Built(order, [arrays(solid) for solid in meshes["solids"]], made["report"])
