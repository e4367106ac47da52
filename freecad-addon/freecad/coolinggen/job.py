"""What is asked of the sidecar for a blade: a preview, or solids.

No document is touched here, so that it may be done beside the window.
"""

import json
import queue
import tempfile
from dataclasses import dataclass
from pathlib import Path

from . import convert
from .client.latest import Watch
from .client.mesh import Mesh, decode
from .client.sidecar import Sidecar
from .service import sidecar

#: Preview: greatest distance between mesh and surface, mm, and angle between neighbouring normals.
PREVIEW_CHORD_MM, PREVIEW_ANGLE_DEG = 0.1, 25.0


@dataclass(frozen=True)
class Request:
    """A design, the sidecar's name for its model, and the folder of the files that it names."""

    model: str
    design: dict
    folder: str = ""

    def params(self) -> dict:
        """Parameters of ``design/generate``."""
        folder = {"folder": self.folder} if self.folder else {}
        return {"model": self.model, "design": self.design, **folder}


@dataclass(frozen=True)
class Built:
    """A blade's solids, their report, and the manifest's group of each face."""

    report: dict
    solids: list[convert.Solid]
    groups: dict[str, str]


def preview(request: Request, watch: Watch) -> list[Mesh]:
    """Meshes of the design, quickly."""
    reply = _generated(request, watch, 0.9).call(
        "model/tessellate",
        model=request.model,
        chord_mm=PREVIEW_CHORD_MM,
        angle_deg=PREVIEW_ANGLE_DEG,
        cancelled=watch.stopped,
    )
    watch.check()
    return [decode(solid) for solid in reply["solids"]]


def build(request: Request, watch: Watch, *, beside: bool) -> Built:
    """Solids of the design; ``beside``: the shapes are read in another process."""
    server = sidecar()
    report = server.call(
        "design/generate", **request.params(), progress=_part(watch, 0.0, 0.4), cancelled=watch.stopped
    )["report"]
    # Only names, colours and the faces' vertices are looked at.
    coarse = {"chord_mm": 1.0, "angle_deg": 60.0}
    reply = server.call("model/tessellate", model=request.model, cancelled=watch.stopped, **coarse)
    with tempfile.TemporaryDirectory(prefix="coolinggen-") as folder:
        files = server.call(
            "model/export",
            model=request.model,
            folder=folder,
            formats=["brep"],
            solids=["assembly"],
            progress=_part(watch, 0.4, 0.5),
            cancelled=watch.stopped,
        )
        watch.progress("read", 0.5)
        paths = [Path(file["path"]) for file in files["files"]]
        brep = next(path for path in paths if path.suffix == ".brep")
        manifest = json.loads(next(p for p in paths if p.suffix == ".json").read_text(encoding="utf-8"))
        if beside:
            solids = convert.read_beside(brep, reply, watch)
        else:
            solids = convert.read(brep, [decode(solid) for solid in reply["solids"]])
    watch.check()
    return Built(report, solids, {face["name"]: face["group"] for face in manifest["faces"]})


def alone(request: Request) -> Built:
    """``build`` for a FreeCAD without a window: waits until it is done."""
    return build(request, Watch(None, queue.Queue()), beside=False)


def export(request: Request, target: Path, kinds: list[str], watch: Watch) -> list[Path]:
    """Writes a blade's files in formats of the sidecar; the paths."""
    reply = _generated(request, watch, 0.5).call(
        "model/export",
        model=request.model,
        folder=str(target),
        formats=kinds,
        progress=_part(watch, 0.5, 1.0),
        cancelled=watch.stopped,
    )
    return [Path(file["path"]) for file in reply["files"]]


def wall_thickness(request: Request, watch: Watch) -> list[Mesh]:
    """Meshes of the coolant with the wall thickness at their vertices."""
    reply = _generated(request, watch, 0.5).call(
        "model/tessellate",
        model=request.model,
        chord_mm=PREVIEW_CHORD_MM,
        # Colours run between vertices: there must be enough of them.
        angle_deg=8.0,
        solids=["coolant"],
        wall_thickness=True,
        progress=_part(watch, 0.5, 1.0),
        cancelled=watch.stopped,
    )
    return [decode(solid) for solid in reply["solids"]]


def _generated(request: Request, watch: Watch, end: float) -> Sidecar:
    """The sidecar when it has built the design, which is the part of the work up to ``end``."""
    server = sidecar()
    progress = _part(watch, 0.0, end)
    server.call(
        "design/generate", **request.params(), report=False, progress=progress, cancelled=watch.stopped
    )
    return server


def _part(watch: Watch, begin: float, end: float):
    return lambda stage, fraction: watch.progress(stage, begin + (end - begin) * fraction)
