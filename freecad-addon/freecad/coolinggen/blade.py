"""A cooled blade in a document: a design as its property, solids with named faces as its shape."""

import json
import math
import tempfile
from pathlib import Path

import FreeCAD as App
import Part

from .client.sidecar import RefusedError, SidecarError
from .service import sidecar

#: Parts of a design in the order of the shape's solids.
PARTS = ("metal", "insert", "coolant")


class CooledBlade:
    """Keeps the shape of a ``Part::FeaturePython`` the same as its design says."""

    def __init__(self, obj):
        """Gives ``obj`` the properties of a cooled blade."""
        obj.Proxy = self
        self._properties(obj)

    @staticmethod
    def _properties(obj) -> None:
        wanted = (
            ("Design", "App::PropertyString", "The design, JSON"),
            ("Report", "App::PropertyString", "What was measured, JSON"),
            ("SolidNames", "App::PropertyStringList", "Name of each solid of the shape"),
            ("FaceNames", "App::PropertyStringList", "Name of each face of the shape"),
            ("Refusal", "App::PropertyStringList", "What is wrong with the design"),
        )
        for name, kind, description in wanted:
            if name not in obj.PropertiesList:
                obj.addProperty(kind, name, "CoolingGen", description)
            if name != "Design":
                obj.setEditorMode(name, 1)

    def onDocumentRestored(self, obj) -> None:  # noqa: N802 (FreeCAD's name)
        """Adds what objects of an older add-on lack."""
        self._properties(obj)

    def execute(self, obj) -> None:
        """Builds the design. Where it is refused the shape stays, and the document says why."""
        if not obj.Design:
            return
        try:
            shape, report, solids, faces = build(obj.Document.Name + "." + obj.Name, json.loads(obj.Design))
        except RefusedError as refused:
            obj.Refusal = [f"{fault['pointer']}: {fault['message']}" for fault in refused.faults]
            raise RuntimeError("the design was refused:\n" + "\n".join(obj.Refusal)) from refused
        except (SidecarError, ValueError) as error:
            obj.Refusal = [str(error)]
            raise RuntimeError(str(error)) from error
        placement = obj.Placement
        obj.Shape, obj.Placement = shape, placement
        obj.Report, obj.SolidNames, obj.FaceNames, obj.Refusal = json.dumps(report), solids, faces, []

    # All that is worth keeping is in properties. FreeCAD asks by either pair of names.
    def dumps(self):
        return None

    def loads(self, state) -> None:
        pass

    def __getstate__(self):
        return None

    def __setstate__(self, state) -> None:
        pass


def build(model: str, design: dict) -> tuple[Part.Shape, dict, list[str], list[str]]:
    """A design as a compound of solids; its report; the solids' and the faces' names in the shape's order."""
    server = sidecar()
    report = server.call("design/generate", model=model, design=design)["report"]
    with tempfile.TemporaryDirectory(prefix="coolinggen-") as folder:
        files = server.call("model/export", model=model, folder=folder, formats=["step"], solids=["assembly"])
        shape = Part.read(str(Path(files["files"][0]["path"])))
    names = _solid_names(shape.Solids, report)
    order = sorted(range(len(names)), key=lambda k: (PARTS.index(names[k].split("/")[0]), names[k]))
    shape = Part.makeCompound([shape.Solids[k] for k in order])
    return shape, report, [names[k] for k in order], [_face_name(face, report) for face in shape.Faces]


def _solid_names(solids: list[Part.Shape], report: dict) -> list[str]:
    """Names of solids, by their volumes and areas."""

    def off(solid: Part.Shape, known: dict) -> float:
        volume = abs(math.log(abs(solid.Volume) / known["volume_mm3"]))
        return volume + abs(math.log(solid.Area / known["area_mm2"]))

    return [min(report["solids"], key=lambda name: off(solid, report["solids"][name])) for solid in solids]


def _face_name(face: Part.Face, report: dict) -> str:
    """Name of a face, by its centre and area."""
    center, size = face.CenterOfMass, math.sqrt(face.Area)

    def off(known: dict) -> float:
        away = (center - App.Vector(*known["centroid_mm"])).Length
        return away + abs(size - math.sqrt(known["area_mm2"]))

    return min(report["faces"], key=off)["name"]


def new(document, design: dict):
    """A cooled blade in ``document``, built."""
    obj = document.addObject("Part::FeaturePython", "CooledBlade")
    CooledBlade(obj)
    obj.Label = design.get("name", "CooledBlade")
    obj.Design = json.dumps(design, indent=2)
    if App.GuiUp:
        obj.ViewObject.Proxy = 0
    document.recompute()
    return obj
