"""AP242: OpenCASCADE reads the same solids as from AP214, and a name for each face from shape aspects."""

from __future__ import annotations

import pytest
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.StepAP242 import StepAP242_GeometricItemSpecificUsage
from OCP.STEPControl import STEPControl_Reader

import close
import measure
import topology
from occ import sub_shapes


@pytest.fixture(scope="session")
def readers(model) -> dict[str, STEPControl_Reader]:
    found = {}
    for part in model.parts:
        found[part] = STEPControl_Reader()
        path = str(model.file(part, "ap242.step"))
        assert found[part].ReadFile(path) == IFSelect_ReturnStatus.IFSelect_RetDone
        assert found[part].TransferRoots() == len(model.solids(part))
    return found


def test_schema(model):
    for part in model.parts:
        head = model.file(part, "ap242.step").read_text(encoding="utf-8")[:2000]
        assert "FILE_SCHEMA(('AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF {" in head


def test_solids_are_valid_closed_and_as_large(model, readers):
    for part, reader in readers.items():
        shape = reader.OneShape()
        assert topology.faults(shape) == [], part
        assert topology.free_edges(shape) == 0, part
        solids = sub_shapes(shape, topology.SOLID)
        for solid, name in zip(solids, model.in_order(part), strict=True):
            expected = model.report["solids"][name]["volume_mm3"]
            close.assert_volume(measure.volume_adaptive(solid), expected, name)


def test_every_face_of_every_solid_is_a_shape_aspect_of_its_name(model, readers):
    of_solid = {solid["name"]: sorted(solid["faces"]) for solid in model.manifest["solids"]}
    for part, reader in readers.items():
        entities = reader.WS().Model()
        found = []
        for k in range(1, entities.NbEntities() + 1):
            usage = entities.Value(k)
            if isinstance(usage, StepAP242_GeometricItemSpecificUsage):
                aspect = usage.Definition().ShapeAspect().Name().ToCString()
                assert usage.NbIdentifiedItem() == 1
                # The face that it points at has a label of its own.
                assert usage.IdentifiedItemValue(1).Name().ToCString() == aspect
                found.append(aspect)
        assert sorted(found) == sorted(name for solid in model.solids(part) for name in of_solid[solid]), part
