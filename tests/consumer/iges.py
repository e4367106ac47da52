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

MANIFOLD_SOLID, FACE, TRIMMED_SURFACE = 186, 510, 144


@dataclass(frozen=True)
class LabelledFace:
    label: str
    level: int
    coloured: bool
    shape: TopoDS_Shape


@dataclass(frozen=True)
class File:
    """The shapes of the independent entities, and their faces with what the directory says of each."""

    kinds: set[int]
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
    faces, kinds, met = [], set(), set()
    model = reader.IGESModel()
    entities = [model.Entity(i) for i in range(1, model.NbEntities() + 1)]
    kinds = {e.TypeNumber() for e in entities}
    for entity in entities:
        if entity.TypeNumber() not in (FACE, TRIMMED_SURFACE):
            continue
        shape = transfer.ShapeResult(entity)
        label = entity.ShortLabel().ToCString()
        assert label not in met, f"{path.name}: the label {label} twice"
        met.add(label)
        faces.append(LabelledFace(label, entity.Level(), entity.RankColor() != 0, shape))
    checks = transfer.TransientProcess().CheckList(False)
    checks.Start()
    complaints = 0
    while checks.More():
        check = checks.Value()
        complaints += check.NbFails() + check.NbWarnings()
        checks.Next()
    return File(kinds, shapes, faces, complaints)


def sewn(faces: list[TopoDS_Shape], tolerance: float) -> tuple[list[TopoDS_Shape], int]:
    """The shells that faces sew to, and the edges left free."""
    sewing = BRepBuilderAPI_Sewing(tolerance)
    for face in faces:
        sewing.Add(face)
    sewing.Perform()
    return sub_shapes(sewing.SewedShape(), topology.SHELL), sewing.NbFreeEdges()
