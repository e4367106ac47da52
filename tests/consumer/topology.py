"""What OpenCASCADE says of a solid's topology: validity, free edges, tolerances, genus."""

from __future__ import annotations

from OCP.BRep import BRep_Tool
from OCP.BRepCheck import BRepCheck_Analyzer, BRepCheck_Status
from OCP.collections import (
    IndexedDataMap_TopoDS_Shape_List_TopoDS_Shape_TopTools_ShapeMapHasher as AncestorMap,
)
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Shape

from occ import sub_shapes

VERTEX, EDGE = TopAbs_ShapeEnum.TopAbs_VERTEX, TopAbs_ShapeEnum.TopAbs_EDGE
WIRE, FACE = TopAbs_ShapeEnum.TopAbs_WIRE, TopAbs_ShapeEnum.TopAbs_FACE
SHELL, SOLID = TopAbs_ShapeEnum.TopAbs_SHELL, TopAbs_ShapeEnum.TopAbs_SOLID


def faults(shape: TopoDS_Shape) -> list[str]:
    """BRepCheck's complaints, empty for a valid shape."""
    check = BRepCheck_Analyzer(shape)
    if check.IsValid():
        return []
    found = []
    for kind in (VERTEX, EDGE, WIRE, FACE, SHELL, SOLID):
        for number, part in enumerate(sub_shapes(shape, kind)):
            for status in check.Result(part).Status():
                if status != BRepCheck_Status.BRepCheck_NoError:
                    found.append(f"{kind.name} {number}: {status.name}")
    return found or ["invalid in context"]


def edges(shape: TopoDS_Shape) -> list:
    return [e for e in map(TopoDS.Edge, sub_shapes(shape, EDGE)) if not BRep_Tool.Degenerated_s(e)]


def free_edges(shape: TopoDS_Shape) -> int:
    """Edges that do not have material on exactly two sides; a seam counts its face twice."""
    faces_of = AncestorMap()
    TopExp.MapShapesAndAncestors_s(shape, EDGE, FACE, faces_of)
    return sum(faces_of.FindFromKey(e).Size() != 2 for e in edges(shape))


def greatest_tolerance(shape: TopoDS_Shape) -> float:
    vertices = [BRep_Tool.Tolerance_s(TopoDS.Vertex(v)) for v in sub_shapes(shape, VERTEX)]
    faces = [BRep_Tool.Tolerance_s(TopoDS.Face(f)) for f in sub_shapes(shape, FACE)]
    return max(vertices + faces + [BRep_Tool.Tolerance_s(e) for e in edges(shape)])


def genus(shape: TopoDS_Shape) -> float:
    """Handles by the Euler-Poincare formula: shells - (V - E + F - (W - F)) / 2, voids and lumps included."""
    vertices, wires = len(sub_shapes(shape, VERTEX)), len(sub_shapes(shape, WIRE))
    faces, shells = len(sub_shapes(shape, FACE)), len(sub_shapes(shape, SHELL))
    return shells - (vertices - len(edges(shape)) + faces - (wires - faces)) / 2
