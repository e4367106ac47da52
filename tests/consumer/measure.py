"""Volumes and boxes of an OpenCASCADE shape: its own two rules, and a curved mesh integrated here."""

from __future__ import annotations

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepGProp import BRepGProp
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_Orientation, TopAbs_ShapeEnum
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape

from occ import sub_shapes


def volume_fixed(shape: TopoDS_Shape) -> float:
    """The fixed Gauss rule: what FreeCAD and build123d show."""
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties)
    return properties.Mass()


def volume_adaptive(shape: TopoDS_Shape, accuracy: float = 1e-6) -> float:
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties, accuracy)
    return properties.Mass()


def area(shape: TopoDS_Shape) -> float:
    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, properties)
    return properties.Mass()


def box(shape: TopoDS_Shape) -> np.ndarray:
    """[[least x, y, z], [greatest x, y, z]] of the exact geometry, tolerances left out."""
    found = Bnd_Box()
    BRepBndLib.AddOptimal_s(shape, found, False, False)
    found.SetGap(0.0)
    return np.array([_point(found.CornerMin()), _point(found.CornerMax())])


def volume_mesh(shape: TopoDS_Shape, chord: float = 0.02, angle: float = 0.15) -> float:
    """Volume within six-node curved triangles: OpenCASCADE's mesh with the middle of every side put on the
    surface, or on the edge's own curve along an edge, so that the mesh stays closed. Fourth order."""
    BRepTools.Clean_s(shape)
    BRepMesh_IncrementalMesh(shape, chord, False, angle, False)
    faces = [TopoDS.Face(f) for f in sub_shapes(shape, TopAbs_ShapeEnum.TopAbs_FACE)]
    middle = box(shape).mean(0)
    return sum(_face_volume(face, middle) for face in faces)


# Degree 4 rule on the triangle (Dunavant, six points): weight, then the three barycentric coordinates.
_A, _B = 0.445948490915965, 0.091576213509771
_RULE = [
    (weight, corner)
    for weight, a in ((0.223381589678011, _A), (0.109951743655322, _B))
    for corner in ((a, a, 1 - 2 * a), (a, 1 - 2 * a, a), (1 - 2 * a, a, a))
]


def _face_volume(face: TopoDS_Face, origin: np.ndarray) -> float:
    corners, middles = _curved_triangles(face)
    nodes = np.concatenate([corners, middles], axis=1) - origin
    total = 0.0
    for weight, (a, b, c) in _RULE:
        shape = np.array([a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c, 4 * c * a])
        along_b = np.array([1 - 4 * a, 4 * b - 1, 0, 4 * (a - b), 4 * c, -4 * c])
        along_c = np.array([1 - 4 * a, 0, 4 * c - 1, -4 * b, 4 * b, 4 * (a - c)])
        point, db, dc = (np.einsum("k,tkx->tx", values, nodes) for values in (shape, along_b, along_c))
        total += weight * float((point * np.cross(db, dc)).sum()) / 6
    return -total if face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED else total


def _curved_triangles(face: TopoDS_Face) -> tuple[np.ndarray, np.ndarray]:
    """Corners (t, 3, 3) and middles of the sides 01, 12, 20 (t, 3, 3), turning with the surface's normal."""
    location = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(face, location)
    assert mesh is not None, "OpenCASCADE left a face without a mesh"
    nodes = range(1, mesh.NbNodes() + 1)
    places = np.array([_point(mesh.Node(i).Transformed(location.Transformation())) for i in nodes])
    parameters = np.array([(uv.X(), uv.Y()) for uv in map(mesh.UVNode, nodes)])
    triangles = np.array([mesh.Triangle(i).Get() for i in range(1, mesh.NbTriangles() + 1)]) - 1
    on_edges = _edge_middles(face, mesh, location)
    surface = BRepAdaptor_Surface(face, False)

    sides: dict[tuple[int, int], np.ndarray] = {}

    def middle(i: int, j: int) -> np.ndarray:
        key = (min(i, j), max(i, j))
        if key not in sides:
            found = on_edges.get(key)
            sides[key] = (
                _point(surface.Value(*(parameters[i] + parameters[j]) / 2)) if found is None else found
            )
        return sides[key]

    middles = np.array([[middle(i, j), middle(j, k), middle(k, i)] for i, j, k in triangles])
    return places[triangles], middles


def _edge_middles(face: TopoDS_Face, mesh, location) -> dict[tuple[int, int], np.ndarray]:
    """Middle points of the mesh sides that lie on the face's edges, by their pair of nodes."""
    found = {}
    for shape in sub_shapes(face, TopAbs_ShapeEnum.TopAbs_EDGE):
        edge = TopoDS.Edge(shape)
        if BRep_Tool.Degenerated_s(edge):
            continue
        curve = BRepAdaptor_Curve(edge)
        # A seam has two polygons on its face, one for each of its two directions.
        for sense in (edge, TopoDS.Edge(edge.Reversed())):
            polygon = BRep_Tool.PolygonOnTriangulation_s(sense, mesh, location)
            if polygon is None:
                continue
            nodes = [polygon.Node(i) - 1 for i in range(1, polygon.NbNodes() + 1)]
            at = [polygon.Parameter(i) for i in range(1, polygon.NbNodes() + 1)]
            for k in range(len(nodes) - 1):
                pair = (min(nodes[k : k + 2]), max(nodes[k : k + 2]))
                found[pair] = _point(curve.Value((at[k] + at[k + 1]) / 2))
    return found


def _point(p) -> np.ndarray:
    return np.array([p.X(), p.Y(), p.Z()])
