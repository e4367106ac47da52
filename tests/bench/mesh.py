#!/usr/bin/env python3
"""Tessellation beside OpenCASCADE's BRepMesh: the same solids, chord and angle, one thread, processor time.

    tests/.venv/bin/python tests/bench/mesh.py [SAMPLE ...] [--chord 0.02] [--angle 15] [--least 5]

Every solid is tessellated by `coolinggen-bench-mesh` (least of several runs), written as STEP, read by
OpenCASCADE and meshed with BRepMesh_IncrementalMesh. Prints milliseconds, triangles, the greatest distance
between triangles and surface at the same parameters, and the ratio of the times; with --least an
error where it is smaller, or where coolinggen has more triangles. BRepMesh's distances are measured the
same way.
"""

from __future__ import annotations

import argparse
import math
import os
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.gp import gp_Pnt, gp_Vec
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from run import REPOSITORY, answer

SAMPLES = ["rotor", "rotor-serpentine", "c3x-film", "vane-insert", "propeller"]
BINARY = Path(os.environ.get("COOLINGGEN_BENCH_MESH", REPOSITORY / "target/release/coolinggen-bench-mesh"))
# The places of coolinggen-bench-mesh.
PLACES = np.array([[3, 3, 0], [0, 3, 3], [3, 0, 3], [2, 2, 2], [4, 1, 1], [1, 4, 1], [1, 1, 4]], dtype=float)
PLACES /= 6


def faces(shape):
    explorer = TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_FACE)
    while explorer.More():
        yield TopoDS.Face(explorer.Current())
        explorer.Next()


def read(path: Path):
    reader = STEPControl_Reader()
    assert reader.ReadFile(str(path)) == IFSelect_ReturnStatus.IFSelect_RetDone, path
    reader.TransferRoots()
    return reader.OneShape()


def peer(path: Path, chord: float, angle: float, runs: int) -> tuple[float, int, float]:
    """Least milliseconds of BRepMesh, its triangles, and how far they are from their surfaces, mm."""
    shape = read(path)
    least = math.inf
    for _ in range(runs):
        BRepTools.Clean_s(shape)
        start = time.process_time()
        BRepMesh_IncrementalMesh(shape, chord, False, math.radians(angle), False)
        least = min(least, time.process_time() - start)
    count, worst = 0, 0.0
    for face in faces(shape):
        mesh = BRep_Tool.Triangulation_s(face, TopLoc_Location())
        count += mesh.NbTriangles()
        worst = max(worst, deviation(face, mesh))
    return 1000 * least, count, worst


def deviation(face, mesh) -> float:
    """Of a thousand triangles of the face at most, spread evenly."""
    surface = BRepAdaptor_Surface(face, False)
    nodes = [mesh.Node(i + 1) for i in range(mesh.NbNodes())]
    parameters = [mesh.UVNode(i + 1) for i in range(mesh.NbNodes())]
    at = np.array([[p.X(), p.Y(), p.Z()] for p in nodes])
    uv = np.array([[p.X(), p.Y()] for p in parameters])
    worst = 0.0
    point, du, dv = gp_Pnt(), gp_Vec(), gp_Vec()
    for i in range(0, mesh.NbTriangles(), mesh.NbTriangles() // 1000 + 1):
        corners = [k - 1 for k in mesh.Triangle(i + 1).Get()]
        for (u, v), p in zip(PLACES @ uv[corners], PLACES @ at[corners], strict=True):
            surface.D1(u, v, point, du, dv)
            normal = du.Crossed(dv)
            if normal.Magnitude() > 0:
                off = normal.Normalized().Dot(gp_Vec(point, gp_Pnt(*p)))
                worst = max(worst, abs(off))
    return worst


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("samples", nargs="*", default=SAMPLES)
    parser.add_argument("--chord", type=float, default=0.02, help="mm")
    parser.add_argument("--angle", type=float, default=15.0, help="degrees")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--core", type=int, default=min(os.sched_getaffinity(0)))
    parser.add_argument("--least", type=float, help="smallest ratio allowed")
    options = parser.parse_args()
    os.sched_setaffinity(0, {options.core})
    print(f"{'':34}{'coolinggen':>32}{'BRepMesh':>32}")
    print(f"{'':34}" + 2 * f"{'ms':>10}{'triangles':>11}{'chord':>11}" + f"{'ratio':>8}")
    missed = []
    for sample in options.samples:
        design = REPOSITORY / f"samples/{sample}.json"
        with tempfile.TemporaryDirectory() as folder:
            rows = answer(options.core, BINARY, design, folder, options.chord, options.angle, options.runs)
            for row in rows:
                ms, triangles, chord = peer(Path(row["step"]), options.chord, options.angle, options.runs)
                ratio = ms / row["milliseconds"]
                print(
                    f"{sample + ' ' + row['solid']:34.34}"
                    f"{row['milliseconds']:10.1f}{row['triangles']:11}{row['chord_mm']:11.4f}"
                    f"{ms:10.1f}{triangles:11}{chord:11.4f}{ratio:8.1f}",
                    flush=True,
                )
                if options.least and (ratio < options.least or row["triangles"] > triangles):
                    missed.append(f"{sample} {row['solid']}")
    if missed:
        sys.exit(f"slower than {options.least} times BRepMesh, or more triangles: {', '.join(missed)}")


if __name__ == "__main__":
    main()
