"""Designs into meshes. Nothing here touches Blender's data, so that it can run beside the window."""

import contextlib
import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from mathutils.bvhtree import BVHTree

from .client.latest import Watch
from .client.sidecar import RefusedError, Sidecar, SidecarError
from .meshes import Arrays, arrays

#: Greatest distance between a blade and the mesh that points are compared with, mm.
FINE = 0.001


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
    wall_thickness: bool = False
    """Whether the thickness of the walls is wanted with the meshes."""


@dataclass(frozen=True)
class Built:
    """What became of it."""

    order: Order
    solids: list[Arrays]
    report: str
    """What was measured, JSON."""


def build(order: Order, connect: Callable[[], Sidecar], watch: Watch) -> Built:
    """The meshes of a design.

    Raises what the sidecar answers; the pointers of a refusal are relative to the design.
    """
    server = connect()
    report = _generate(server, order, order.design, order.model, watch)
    meshes = server.call(
        "model/tessellate",
        model=order.model,
        wall_thickness=order.wall_thickness,
        **_tolerances(order),
        **_watched(watch),
    )
    return Built(order, [arrays(solid) for solid in meshes["solids"]], json.dumps(report))


def export(
    order: Order, folder: Path, formats: list[str], connect: Callable[[], Sidecar], watch: Watch
) -> list[str]:
    """Writes the files of a design; their paths. Raises as :func:`build`."""
    server = connect()
    # A model of its own: what is written is what was asked for, even if the design changes meanwhile.
    model = f"{order.model}-export"
    with _forgotten(server, model):
        _generate(server, order, order.design, model, watch)
        written = server.call(
            "model/export",
            model=model,
            folder=str(folder),
            formats=formats,
            **_tolerances(order),
            **_watched(watch),
        )
    return [file["path"] for file in written["files"]]


def distance(
    order: Order, points: np.ndarray, connect: Callable[[], Sidecar], watch: Watch
) -> tuple[float, np.ndarray]:
    """The greatest distance, mm, of points from the bare blade of a design, and which of them it is.

    The blade is a mesh whose chords lie within ``FINE`` mm of it. Raises as :func:`build`.
    """
    server = connect()
    model = f"{order.model}-bare"
    with _forgotten(server, model):
        _generate(server, order, {**order.design, "cooling": {}}, model, watch)
        meshes = server.call(
            "model/tessellate", model=model, chord_mm=FINE, angle_deg=order.angle_deg, **_watched(watch)
        )
    bare = next(arrays(solid) for solid in meshes["solids"] if solid["name"] == "metal")
    outside = [k for k, (layer, _) in enumerate(bare.layers) if layer == "blade"]
    triangles = bare.triangles[np.isin(bare.layer_of, outside)]
    tree = BVHTree.FromPolygons(bare.points.tolist(), triangles.tolist())
    away = [tree.find_nearest(point)[3] for point in points.tolist()]
    farthest = int(np.argmax(away))
    return away[farthest], points[farthest]


@contextlib.contextmanager
def _forgotten(server: Sidecar, model: str):
    """Has the server forget a model that is needed no more."""
    try:
        yield
    finally:
        with contextlib.suppress(SidecarError):
            server.call("model/close", model=model)


def _generate(server: Sidecar, order: Order, design: dict, model: str, watch: Watch) -> dict:
    folder = {"folder": order.folder} if order.folder else {}
    try:
        made = server.call("design/generate", model=model, design=design, **folder, **_watched(watch))
    except RefusedError as refused:
        faults = [{**fault, "pointer": fault["pointer"].removeprefix("/design")} for fault in refused.faults]
        raise RefusedError(str(refused), faults) from refused
    return made["report"]


def _tolerances(order: Order) -> dict:
    return {"chord_mm": order.chord_mm, "angle_deg": order.angle_deg}


def _watched(watch: Watch) -> dict:
    return {"progress": watch.progress, "cancelled": watch.stopped}
