"""AP242: OpenCASCADE reads the same solids as from AP214; exporters/tests/step.rs has the shape aspects."""

from __future__ import annotations

import pytest
from OCP.IFSelect import IFSelect_ReturnStatus
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
