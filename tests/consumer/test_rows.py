"""Rows in OpenCASCADE: hub, shroud and blades are sound, and blades stand on the walls' own surfaces."""

from __future__ import annotations

import json

import numpy as np
import pytest
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.gp import gp_Pnt
from OCP.TopoDS import TopoDS

import cli
import close
import occ
import topology

ROWS = {
    "francis": {"hub": {"thickness": 8}, "shroud": {"thickness": 6}},
    "kaplan": {"count": 4, "hub": {"thickness": 10}},
    "propeller": {"count": 3, "hub": {"thickness": 8}},
}
NEAR = 0.5  # mm; whatever of a blade is nearer to a wall lies on it
PLACES = 7  # of an edge


def points_of(edge) -> list[gp_Pnt]:
    curve = BRepAdaptor_Curve(edge)
    return [curve.Value(float(t)) for t in np.linspace(curve.FirstParameter(), curve.LastParameter(), PLACES)]


def distance(point: gp_Pnt, shape) -> float:
    return BRepExtrema_DistShapeShape(BRepBuilderAPI_MakeVertex(point).Vertex(), shape).Value()


@pytest.mark.parametrize("row", ROWS)
def test_blades_stand_on_walls_that_are_sound(row, tmp_path):
    design = json.loads((cli.SAMPLES / f"{row}.json").read_text(encoding="utf-8"))
    path = tmp_path / "row.json"
    path.write_text(json.dumps(design | {"name": "row", "pattern": ROWS[row]}), encoding="utf-8")
    done = cli.run("generate", path, "--out", tmp_path, "--format", "step", "--solids", "assembly")
    assert done.returncode == cli.DONE, done.stderr
    solids = {p.name: p.shape for p in occ.read(tmp_path / "row.assembly.step")}
    walls = [name for name in ("hub", "shroud") if name in ROWS[row]]
    for name, shape in solids.items():
        assert not topology.faults(shape), name
        assert topology.free_edges(shape) == 0, name
        assert topology.greatest_tolerance(shape) <= close.TOLERANCE_MM, name
        assert topology.genus(shape) == (1 if name in walls else 0), name
    for wall in walls:
        feet = [
            edge
            for edge in map(TopoDS.Edge, topology.edges(solids["metal"]))
            if max(distance(p, solids[wall]) for p in points_of(edge)[:: PLACES - 1]) < NEAR
        ]
        assert len(feet) >= 3, f"{wall}: {len(feet)} edges of the blade"
        worst = max(distance(p, solids[wall]) for edge in feet for p in points_of(edge))
        assert worst < close.TOLERANCE_MM, f"{wall}: a root {worst} mm off"
