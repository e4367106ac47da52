"""Blades that are in a document or in a STEP file already: their B-spline surfaces, taken as they are."""

import itertools
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import FreeCAD as App
import Part

from .client import begin

#: Points a border or a surface is looked at in each direction.
SAMPLES = 40


@dataclass(frozen=True)
class Chosen:
    """A design for what is selected, the file of its surfaces, if any, and where it stands."""

    design: dict
    file: str
    placement: App.Placement
    drawn: object = None  #: The object that was selected.


@dataclass(frozen=True)
class Found:
    """The B-spline surfaces of a blade and points all over them."""

    faces: list[Part.Face]
    points: list[App.Vector]


def selected() -> Chosen:
    """A design for the selected faces or solid, in that object's own coordinates. Raises ValueError if
    there are no B-spline surfaces among them.
    """
    import FreeCADGui as Gui

    chosen = Gui.Selection.getSelectionEx("", 0)
    if len(chosen) != 1:
        raise ValueError("select one object, or faces of one")
    item = chosen[0]
    names = [name for name in item.SubElementNames if name.split(".")[-1].startswith("Face")]
    obj, placement, shape = _resolved(item, names)
    faces = [shape.getElement(n.split(".")[-1]) for n in names] or shape.Faces
    return replace(of_shape(faces, placement, obj.Label), drawn=obj)


def _resolved(item, names: list[str]):
    """The object that a selection means, its place in the world, and its shape in its own coordinates."""
    path = (names or list(item.SubElementNames) or [""])[0]
    path = path[: path.rfind(".") + 1]
    obj = item.Object.getSubObject(path, retType=1) if path else item.Object
    matrix = item.Object.getSubObject(path, retType=4) if path else item.Object.getSubObject("", retType=4)
    if not hasattr(obj, "Shape"):
        raise ValueError(f"{obj.Label} has no shape")
    shape = obj.Shape.copy()
    shape.Placement = App.Placement()
    return obj, App.Placement(matrix), shape


def of_shape(faces: list[Part.Face], placement: App.Placement, label: str) -> Chosen:
    """A design for a blade's faces, which are in their object's own coordinates."""
    found = of_faces(faces)
    name = begin.plain(label)
    if len(found.faces) == 1 and _is_tube(found.faces[0].Surface):
        return Chosen(design(name, found), "", placement)
    folder = Path(tempfile.mkdtemp(prefix="coolinggen-"))
    file = folder / f"{name}.step"
    # A file of its own for the surfaces: in mm whatever the user's preferences, as the shape has no other
    # unit.
    _write_step(Part.makeCompound(found.faces), file)
    return Chosen(design(name, found, file=str(file)), str(file), placement)


def _write_step(shape: Part.Shape, file: Path) -> None:
    shape.exportStep(str(file))


def of_faces(faces: list[Part.Face]) -> Found:
    """The B-spline surfaces among faces. Raises ValueError if there are none."""
    kept = [face for face in faces if isinstance(face.Surface, Part.BSplineSurface)]
    if not kept:
        raise ValueError("there is no B-spline surface among the faces")
    return Found(kept, [p for face in kept for p in _points(face)])


def _points(face: Part.Face) -> list[App.Vector]:
    u0, u1, v0, v1 = face.ParameterRange
    steps = [k / SAMPLES for k in range(SAMPLES + 1)]
    surface = face.Surface
    return [surface.value(u0 + (u1 - u0) * a, v0 + (v1 - v0) * b) for a in steps for b in steps]


def _is_tube(surface: Part.BSplineSurface) -> bool:
    """Whether the surface closes upon itself in one direction, as a blade's does round it."""
    return _closed(surface, along_u=True) != _closed(surface, along_u=False)


def _closed(surface: Part.BSplineSurface, *, along_u: bool) -> bool:
    u0, u1, v0, v1 = surface.bounds()
    size = sum(p.Length for row in surface.getPoles() for p in row) / (surface.NbUPoles * surface.NbVPoles)
    for k in range(SAMPLES + 1):
        t = k / SAMPLES
        if along_u:
            v = v0 + (v1 - v0) * t
            a, b = surface.value(u0, v), surface.value(u1, v)
        else:
            u = u0 + (u1 - u0) * t
            a, b = surface.value(u, v0), surface.value(u, v1)
        if (a - b).Length > 1e-6 * max(size, 1.0):
            return False
    return True


def inline(surface: Part.BSplineSurface) -> dict:
    """A surface as the design's ``surface`` source: control net, knots and weights as FreeCAD has them; u
    runs round the blade.
    """
    surface = surface.copy()
    for periodic, clamp in (
        (surface.isUPeriodic(), surface.setUNotPeriodic),
        (surface.isVPeriodic(), surface.setVNotPeriodic),
    ):
        if periodic:
            clamp()
    if not _closed(surface, along_u=True):
        surface.exchangeUV()
    made = {
        "kind": "surface",
        "degree_u": surface.UDegree,
        "degree_v": surface.VDegree,
        "knots_u": _knots(surface.getUKnots(), surface.getUMultiplicities()),
        "knots_v": _knots(surface.getVKnots(), surface.getVMultiplicities()),
        "points": [[[p.x, p.y, p.z] for p in row] for row in surface.getPoles()],
    }
    if surface.isURational() or surface.isVRational():
        made["weights"] = [list(row) for row in surface.getWeights()]
    return made


def _knots(values: list[float], times: list[int]) -> list[float]:
    return list(itertools.chain.from_iterable([value] * n for value, n in zip(values, times, strict=True)))


def design(name: str, found: Found, *, file: str = "") -> dict:
    """A design with these surfaces and one chamber, as a start."""
    source = {"kind": "step", "file": Path(file).name} if file else inline(found.faces[0].Surface)
    points = [tuple(p) for p in found.points]
    return begin.design(name, points, begin.space(points), source)
