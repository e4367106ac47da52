"""Reads a STEP file through OpenCASCADE's document (XCAF): products, face names, colours and layers."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from OCP.BRep import BRep_Builder
from OCP.collections import (
    IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher as ShapeMap,
)
from OCP.collections import Sequence_TDF_Label
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Interface import Interface_Static
from OCP.Message import Message, Message_Gravity
from OCP.Quantity import Quantity_ColorRGBA
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.StepShape import StepShape_AdvancedFace
from OCP.TCollection import TCollection_AsciiString, TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Compound, TopoDS_Face, TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_ColorTool, XCAFDoc_ColorType, XCAFDoc_DocumentTool

FACE = TopAbs_ShapeEnum.TopAbs_FACE

for printer in Message.DefaultMessenger_s().Printers():
    printer.SetTraceLevel(Message_Gravity.Message_Fail)


@dataclass(frozen=True)
class NamedFace:
    shape: TopoDS_Face
    name: str | None
    colour: tuple[float, float, float] | None
    layers: tuple[str, ...]


@dataclass(frozen=True)
class Product:
    name: str | None
    shape: TopoDS_Shape
    faces: list[NamedFace] = field(repr=False)

    def named(self, prefix: str) -> list[NamedFace]:
        """The faces called `prefix`, or below it when it ends in a slash."""
        whole = not prefix.endswith("/")
        return [
            f for f in self.faces if f.name and (f.name == prefix if whole else f.name.startswith(prefix))
        ]


def sub_shapes(shape: TopoDS_Shape, kind: TopAbs_ShapeEnum) -> list[TopoDS_Shape]:
    """Each sub-shape of this kind once, in the order of the file."""
    found = ShapeMap()
    TopExp.MapShapes_s(shape, kind, found)
    return [found.FindKey(i) for i in range(1, found.Size() + 1)]


def compound(shapes: list[TopoDS_Shape]) -> TopoDS_Compound:
    """Shapes as one, which keeps what they share."""
    whole, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(whole)
    for shape in shapes:
        builder.Add(whole, shape)
    return whole


def read(path: Path) -> list[Product]:
    """The products of a file; those of an assembly are its leaves."""
    document = TDocStd_Document(TCollection_ExtendedString("XCAF"))
    reader = STEPCAFControl_Reader()
    # Known only once a reader exists, and off by default: names on ADVANCED_FACE.
    Interface_Static.SetIVal_s("read.stepcaf.subshapes.name", 1)
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    reader.SetLayerMode(True)
    if reader.ReadFile(str(path)) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise AssertionError(f"OpenCASCADE cannot read {path.name}")
    if not reader.Transfer(document):
        raise AssertionError(f"OpenCASCADE cannot transfer {path.name}")
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    free = Sequence_TDF_Label()
    shapes.GetFreeShapes(free)
    transfer = reader.ChangeReader().WS().TransferReader()
    return [_product(document, leaf, transfer) for label in _items(free) for leaf in _leaves(shapes, label)]


def _name_in_the_file(transfer, face: TopoDS_Shape) -> str | None:
    """The name of the entity that the face was read from. The document lists only the faces of outer shells
    by name (ExpandManifoldSolidBrep), not those of voids."""
    entity = transfer.EntityFromShapeResult(face, 1)
    if not isinstance(entity, StepShape_AdvancedFace) or entity.Name() is None:
        return None
    return entity.Name().ToCString() or None


def _product(document: TDocStd_Document, label: TDF_Label, transfer) -> Product:
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    layers = XCAFDoc_DocumentTool.LayerTool_s(document.Main())
    shape = shapes.GetShape_s(label)
    faces = []
    for face in sub_shapes(shape, FACE):
        of_face = TDF_Label()
        if shapes.FindSubShape(label, face, of_face):
            marks = Sequence_TDF_Label()
            layers.GetLayers(of_face, marks)
            found = (_name(of_face), _colour(of_face), tuple(filter(None, map(_name, _items(marks)))))
        else:
            found = (None, None, ())
        if found[0] is None:
            found = (_name_in_the_file(transfer, face), *found[1:])
        faces.append(NamedFace(TopoDS.Face(face), *found))
    return Product(_name(label), shape, faces)


def _leaves(shapes, label: TDF_Label) -> list[TDF_Label]:
    if not shapes.IsAssembly_s(label):
        return [label]
    parts = Sequence_TDF_Label()
    shapes.GetComponents_s(label, parts)
    leaves = []
    for part in _items(parts):
        referred = TDF_Label()
        shapes.GetReferredShape_s(part, referred)
        leaves += _leaves(shapes, referred)
    return leaves


def _items(sequence: Sequence_TDF_Label) -> list[TDF_Label]:
    return [sequence.Value(i) for i in range(1, sequence.Length() + 1)]


def _name(label: TDF_Label) -> str | None:
    name = TDataStd_Name()
    if not (
        label.IsAttribute(TDataStd_Name.GetID_s()) and label.FindAttribute(TDataStd_Name.GetID_s(), name)
    ):
        return None
    return TCollection_AsciiString(name.Get()).ToCString() or None


def _colour(label: TDF_Label) -> tuple[float, float, float] | None:
    colour = Quantity_ColorRGBA()
    for kind in (XCAFDoc_ColorType.XCAFDoc_ColorSurf, XCAFDoc_ColorType.XCAFDoc_ColorGen):
        if XCAFDoc_ColorTool.GetColor_s(label, kind, colour):
            rgb = colour.GetRGB()
            return (rgb.Red(), rgb.Green(), rgb.Blue())
    return None
