"""Where OpenCASCADE finds the surfaces of two faces to cross, for faces that share an edge.

FreeCAD's BOP check asks this of every pair of faces, which takes minutes for many bores; a pair takes
a few hundredths of a second.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator

from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GeomAPI import GeomAPI_ProjectPointOnCurve
from OCP.IntTools import IntTools_FaceFace
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopoDS import TopoDS

import occ

STEPS = 40


def edges(face: occ.NamedFace) -> list:
    return [TopoDS.Edge(edge) for edge in occ.sub_shapes(face.shape, TopAbs_ShapeEnum.TopAbs_EDGE)]


def middle(edge) -> tuple[float, ...]:
    """By which an edge is known again, to 1e-5 mm."""
    curve = BRepAdaptor_Curve(edge)
    point = curve.Value(0.5 * (curve.FirstParameter() + curve.LastParameter()))
    return tuple(round(x, 5) for x in (point.X(), point.Y(), point.Z()))


def neighbours(product: occ.Product, prefix: str) -> Iterator[tuple[occ.NamedFace, occ.NamedFace]]:
    """The faces below `prefix`, each with every other face that it shares an edge with."""
    sharing = defaultdict(list)
    for face in product.faces:
        for edge in edges(face):
            sharing[middle(edge)].append(face)
    met = set()
    for face in product.named(prefix):
        for other in [other for edge in edges(face) for other in sharing[middle(edge)] if other is not face]:
            pair = frozenset((id(face), id(other)))
            if pair not in met:
                met.add(pair)
                yield face, other


def beside_edges(face: occ.NamedFace, other: occ.NamedFace) -> float:
    """How far from every edge of the first face, mm, OpenCASCADE finds the second one to cross it."""
    crossing = IntTools_FaceFace()
    crossing.SetParameters(True, True, True, 1e-7)  # as the check sets them
    crossing.Perform(face.shape, other.shape)
    assert crossing.IsDone(), f"{face.name} and {other.name}"
    curves = [BRep_Tool.Curve_s(edge, 0.0, 1.0) for edge in edges(face)]
    worst = 0.0
    for line in crossing.Lines():
        curve = line.Curve()
        start, end = curve.FirstParameter(), curve.LastParameter()
        for k in range(STEPS + 1):
            point = curve.Value(start + (end - start) * k / STEPS)
            feet = (GeomAPI_ProjectPointOnCurve(point, own) for own in curves)
            away = min((foot.LowerDistance() for foot in feet if foot.NbPoints()), default=math.inf)
            worst = max(worst, away)
    return worst
