"""Reads an IGES file through OpenCASCADE: its shapes, and what the directory says of its faces."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from OCP.BRepBuilderAPI import BRepBuilderAPI_Sewing
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.IGESControl import IGESControl_Reader
from OCP.TopoDS import TopoDS_Shape

import topology
from occ import sub_shapes

# Types of entities.
FACE, TRIMMED_SURFACE = 510, 144


@dataclass(frozen=True)
class LabelledFace:
    label: str
    level: int
    coloured: bool
    shape: TopoDS_Shape | None


@dataclass(frozen=True)
class File:
    """The shapes of the independent entities; the faces in the order of the file; fails and warnings."""

    shapes: list[TopoDS_Shape]
    faces: list[LabelledFace]
    complaints: int


def read(path: Path) -> File:
    reader = IGESControl_Reader()
    if reader.ReadFile(str(path)) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise AssertionError(f"OpenCASCADE cannot read {path.name}")
    reader.TransferRoots()
    transfer = reader.WS().TransferReader()
    shapes = [reader.Shape(i) for i in range(1, reader.NbShapes() + 1)]
    made = {}
    for shape in shapes:
        for face in sub_shapes(shape, topology.FACE):
            made[transfer.EntityFromShapeResult(face, 1).ShortLabel().ToCString()] = face
    model = reader.IGESModel()
    entities = [model.Entity(i) for i in range(1, model.NbEntities() + 1)]
    faces = []
    for entity in entities:
        if entity.TypeNumber() in (FACE, TRIMMED_SURFACE):
            label = entity.ShortLabel().ToCString()
            faces.append(LabelledFace(label, entity.Level(), entity.RankColor() != 0, made.get(label)))
    checks = transfer.TransientProcess().CheckList(False)
    checks.Start()
    complaints = 0
    while checks.More():
        check = checks.Value()
        complaints += check.NbFails() + check.NbWarnings()
        checks.Next()
    return File(shapes, faces, complaints)


def sewn(faces: list[TopoDS_Shape], tolerance: float) -> tuple[list[TopoDS_Shape], int]:
    """The shells that faces sew to, and the edges left free."""
    sewing = BRepBuilderAPI_Sewing(tolerance)
    for face in faces:
        sewing.Add(face)
    sewing.Perform()
    return sub_shapes(sewing.SewedShape(), topology.SHELL), sewing.NbFreeEdges()
