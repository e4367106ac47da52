#!/usr/bin/env python3
"""The blade of a medial design skinned from a point cloud in build123d / OpenCASCADE, as it is done today.

    medial_peer.py DESIGN.json OURS.step OUT.step

The cloud is taken, untimed, from the outer surfaces of our own STEP file. Timed are: a spline a face through
the points of each section, a loft through them, filled end faces, and the STEP file. The ends stay where the
cloud ends, past hub and shroud: the cut by them that ours has is left out. Prints one JSON record of
processor seconds.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
from build123d import Compound, Edge, Face, Shell, Solid, Wire, export_step, import_step
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBuilderAPI import BRepBuilderAPI_Sewing
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepOffsetAPI import BRepOffsetAPI_ThruSections
from OCP.GeomAbs import GeomAbs_BSplineSurface
from scipy.interpolate import CubicSpline

from rotor_peer import Stopwatch, volume

SECTIONS = 25
POINTS = 61  # a face and section, as many as the error tables have a side


def cloud(step: Path, hub: np.ndarray) -> list[np.ndarray]:
    """Points of each outer face, `[section][place]` from the hub on, over the whole of its surface."""
    found = []
    for face in import_step(str(step)).faces():
        surface = BRepAdaptor_Surface(face.wrapped, False)
        if surface.GetType() != GeomAbs_BSplineSurface:
            continue
        ends = [
            (surface.FirstUParameter(), surface.LastUParameter()),
            (surface.FirstVParameter(), surface.LastVParameter()),
        ]

        # Some files run along the span in u, some in v.
        rise = [climb(grid(surface, ends, way, 3, 3), hub) for way in (0, 1)]
        way = int(abs(rise[1]) > abs(rise[0]))
        points = grid(surface, ends, way, SECTIONS, POINTS)
        found.append(points if rise[way] > 0 else points[::-1])
    return found


def grid(surface, ends: list[tuple[float, float]], way: int, sections: int, places: int) -> np.ndarray:
    """Points of a surface, a row a section; sections follow each other along its parameter `way`."""
    along, around = np.linspace(*ends[way], sections), np.linspace(*ends[1 - way], places)
    at = [[(a, b) if way == 0 else (b, a) for b in around] for a in along]
    points = [[surface.Value(float(u), float(v)) for u, v in row] for row in at]
    return np.array([[(p.X(), p.Y(), p.Z()) for p in row] for row in points])


def climb(points: np.ndarray, hub: np.ndarray) -> float:
    """How much farther from the hub's contour the last row of a grid is than the first."""

    def away(row: np.ndarray) -> float:
        meridional = np.column_stack([row[:, 0], np.hypot(row[:, 1], row[:, 2])])
        return float(np.mean([np.linalg.norm(hub - p, axis=1).min() for p in meridional]))

    return away(points[-1]) - away(points[0])


def contour(spec) -> np.ndarray:
    points = np.array(spec, float)
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    return CubicSpline(along, points)(np.linspace(0, along[-1], 41))


def wire(pieces: list[np.ndarray]) -> Wire:
    """One section: the faces' points, each beginning where the last ended."""
    edges = []
    for k, points in enumerate(pieces):
        inner = [tuple(map(float, p)) for p in points]
        inner[-1] = tuple(map(float, pieces[(k + 1) % len(pieces)][0]))
        edges.append(Edge.make_spline(inner))
    return Wire(edges)


def ring(pieces: list[np.ndarray]) -> list[np.ndarray]:
    """The faces in the order in which they follow each other, all run through the same way."""
    chain, rest = [pieces[0]], list(pieces[1:])
    while rest:
        end = chain[-1][0][-1]
        gaps = [min(np.linalg.norm(p[0][0] - end), np.linalg.norm(p[0][-1] - end)) for p in rest]
        following = rest.pop(int(np.argmin(gaps)))
        turned = np.linalg.norm(following[0][0] - end) > np.linalg.norm(following[0][-1] - end)
        chain.append(following[:, ::-1] if turned else following)
    return chain


def skinned(wires: list[Wire]):
    """The shell through the sections, whose ends are not plane."""
    maker = BRepOffsetAPI_ThruSections(False, False, 1e-6)
    maker.CheckCompatibility(False)
    for section in wires:
        maker.AddWire(section.wrapped)
    maker.Build()
    return maker.Shape()


def main() -> None:
    design = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    faces = ring(cloud(Path(sys.argv[2]), contour(design["space"]["hub"])))
    watch = Stopwatch()
    with watch.stage("sections"):
        wires = [wire([face[j] for face in faces]) for j in range(SECTIONS)]
    with watch.stage("loft"):
        skin = skinned(wires)
    with watch.stage("ends"):
        sewing = BRepBuilderAPI_Sewing(1e-3)
        for shape in (skin, *(Face.make_surface(end.edges()).wrapped for end in (wires[0], wires[-1]))):
            sewing.Add(shape)
        sewing.Perform()
        blade = Solid(Shell(sewing.SewedShape())).wrapped
    with watch.stage("step"):
        export_step(Compound(blade), sys.argv[3])
    record = {
        "seconds": {name: round(value, 4) for name, value in watch.seconds.items()},
        "total_s": round(sum(watch.seconds.values()), 4),
        "volume_mm3": volume(blade),
        "valid": BRepCheck_Analyzer(blade).IsValid(),
    }
    print(json.dumps(record))


if __name__ == "__main__":
    main()
