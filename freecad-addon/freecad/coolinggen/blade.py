"""A cooled blade in a document: its design is a property; its solids, a feature each, follow it."""

import contextlib
import hashlib
import json
from pathlib import Path

import FreeCAD as App

from . import job
from .client.sidecar import RefusedError, SidecarError
from .proxy import Proxy

#: Parts of a design in the order in which they stand in the tree.
PARTS = ("metal", "insert", "coolant", "hub", "shroud")

_PROPERTIES = (
    ("Design", "App::PropertyString", "The design, JSON"),
    (
        "BladeFile",
        "App::PropertyFileIncluded",
        "The STEP file with the blade's surface, kept in the document",
    ),
    ("Solids", "App::PropertyLinkListGlobal", "The blade's solids"),
    ("Report", "App::PropertyString", "What was measured, JSON"),
    ("Refusal", "App::PropertyStringList", "What is wrong with the design"),
    ("Faults", "App::PropertyString", "The same with its fields, JSON"),
    ("Built", "App::PropertyString", "The design that the solids are made of, as a digest"),
)
_HIDDEN = ("Report", "Faults", "Built")


class CooledBlade(Proxy):
    """Keeps the solids of an ``App::FeaturePython`` the same as its design says."""

    def __init__(self, obj):
        """Gives ``obj`` the properties of a cooled blade."""
        obj.Proxy = self
        _give(obj, _PROPERTIES, ("Design", "BladeFile"), _HIDDEN)
        if "Placement" not in obj.PropertiesList:
            obj.addProperty("App::PropertyPlacement", "Placement", "Base", "Where the blade stands")

    def onDocumentRestored(self, obj) -> None:  # noqa: N802 (FreeCAD's name)
        """Adds what objects of an older add-on lack."""
        self.__init__(obj)
        _dress(obj)

    def onChanged(self, obj, name: str) -> None:  # noqa: N802 (FreeCAD's name)
        """The solids go where the blade goes."""
        if name == "Placement" and "Restore" not in obj.State:
            _place(obj)

    def execute(self, obj) -> None:
        """Builds the design. Where it is refused the solids stay, and the document says why."""
        if not obj.Design or (obj.Built == _digest(obj) and _own(obj)):
            return
        try:
            built = _waiting(request(obj))
        except RefusedError as refused:
            tell(obj, refused.faults)
            raise RuntimeError("the design was refused:\n" + "\n".join(obj.Refusal)) from refused
        except (SidecarError, ValueError) as error:
            obj.Refusal, obj.Faults = [str(error)], ""
            raise RuntimeError(str(error)) from error
        fill(obj, built)


class CooledSolid(CooledBlade):
    """A solid of a cooled blade: a ``Part::FeaturePython`` that its blade fills."""

    _PROPERTIES = (
        ("SolidName", "App::PropertyString", "Name of the solid"),
        ("FaceNames", "App::PropertyStringList", "Name of each face of the shape"),
        ("FaceGroups", "App::PropertyStringList", "Group of each face of the shape, as in every file"),
        ("FaceColors", "App::PropertyColorList", "Colour of each face of the shape"),
    )

    def __init__(self, obj):
        """Gives ``obj`` the properties of a solid of a blade."""
        obj.Proxy = self
        _give(obj, self._PROPERTIES, (), ("FaceColors",))

    def onChanged(self, obj, name: str) -> None:  # noqa: N802 (FreeCAD's name)
        pass

    def execute(self, obj) -> None:
        pass


def request(obj) -> job.Request:
    """What is asked of the sidecar for this blade. Raises ValueError if its design is no JSON."""
    beside = str(Path(obj.Document.FileName).parent) if obj.Document.FileName else ""
    model = f"{obj.Document.Uid}/{obj.Name}"
    return job.Request(model, *with_file(json.loads(obj.Design), obj.BladeFile, beside))


def with_file(design: dict, file: str, beside: str) -> tuple[dict, str]:
    """The design and the folder of its files: those of ``file``, if its blade is of a STEP file kept in the
    document, under a name that is FreeCAD's affair; else ``beside``."""
    source = design.get("blade") if isinstance(design, dict) else None
    if not file or not isinstance(source, dict) or source.get("kind") != "step":
        return design, beside
    return {**design, "blade": {**source, "file": Path(file).name}}, str(Path(file).parent)


def fill(obj, built: job.Built) -> None:
    """Puts what was built of the blade's present design into its document."""
    children = _own(obj) or []
    known = {child.SolidName: child for child in children}
    solids = []
    for solid in sorted(built.solids, key=lambda s: (_rank(s.name), s.name)):
        child = known.pop(solid.name, None) or _child(obj, solid.name)
        child.Shape = solid.shape
        child.FaceNames = solid.faces
        child.FaceGroups = [built.groups[name] for name in solid.faces]
        child.FaceColors = solid.colors
        solids.append(child)
    obj.Solids = solids
    _place(obj)
    obj.Report, obj.Built = json.dumps(built.report), _digest(obj)
    tell(obj, [])
    for child in known.values():
        obj.Document.removeObject(child.Name)


def tell(obj, faults: list[dict]) -> None:
    """Notes what is wrong with the design, in its properties."""
    obj.Refusal = [f"{pointer(fault) or '/'}: {fault['message']}" for fault in faults]
    obj.Faults = json.dumps(faults) if faults else ""


def pointer(fault: dict) -> str:
    """JSON pointer into the design of a fault of ``design/generate``."""
    return fault["pointer"].removeprefix("/design")


def is_blade(obj) -> bool:
    """Whether ``obj`` is a cooled blade."""
    return type(getattr(obj, "Proxy", None)) is CooledBlade


def blade_of(obj):
    """The cooled blade that ``obj`` is, or is a solid of; none otherwise."""
    if is_blade(obj):
        return obj
    return next((parent for parent in obj.InList if is_blade(parent) and obj in parent.Solids), None)


def rebuild(obj) -> None:
    """Builds the design again, changed or not."""
    obj.Built = ""
    obj.touch()
    obj.Document.recompute()


def new(document, design: dict, *, file: str = "", placement=None, built: job.Built | None = None):
    """A cooled blade in ``document``; built here if it is not yet. ``file``: the STEP file of its surface."""
    obj = document.addObject("App::FeaturePython", "CooledBlade")
    CooledBlade(obj)
    obj.Label = design.get("name", "CooledBlade")
    if file:
        obj.BladeFile = file
    obj.Design = json.dumps(design, indent=2)
    if placement is not None:
        obj.Placement = placement
    _dress(obj)
    if built is not None:
        fill(obj, built)
    document.recompute()
    return obj


def _rank(name: str) -> int:
    part = name.split("/")[0].split("#")[0]
    return PARTS.index(part) if part in PARTS else len(PARTS)


def _child(obj, name: str):
    child = obj.Document.addObject("Part::FeaturePython", "CooledSolid")
    CooledSolid(child)
    child.SolidName = name
    child.Label = name
    _dress(child)
    return child


def _own(obj) -> list | None:
    """The blade's solids, unless another blade has them, too: a copy then needs its own."""
    for child in obj.Solids:
        if any(parent is not obj and is_blade(parent) for parent in child.InList):
            return None
    return list(obj.Solids) or None


def _place(obj) -> None:
    for child in obj.Solids:
        if child.Placement != obj.Placement:
            child.Placement = obj.Placement


def _digest(obj) -> str:
    digest = hashlib.sha256(obj.Design.encode())
    if obj.BladeFile:
        with contextlib.suppress(OSError):
            digest.update(Path(obj.BladeFile).read_bytes())
    return digest.hexdigest()


def _waiting(wanted: job.Request) -> job.Built:
    if not App.GuiUp:
        return job.alone(wanted)
    from . import waiting

    return waiting.build(wanted)


def _give(obj, properties, editable, hidden) -> None:
    for name, kind, description in properties:
        if name not in obj.PropertiesList:
            obj.addProperty(kind, name, "CoolingGen", description)
        if name in hidden:
            obj.setEditorMode(name, 2)
        elif name not in editable:
            obj.setEditorMode(name, 1)


def _dress(obj) -> None:
    """Gives an object its view, where there is a window."""
    if App.GuiUp and getattr(obj.ViewObject, "Proxy", None) in (None, 0):
        from . import view

        view.dress(obj)
