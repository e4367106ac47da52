#!/usr/bin/env python3
"""The blade of samples/rotor.json as it is modelled today, in build123d / OpenCASCADE.

Planar sections through the blade, lofted; the shell's offset drawn in each section, parted by the walls,
filleted and lofted to chambers; hub, tip and chamber ends by revolved solids; metal = blade less chambers.

    rotor_peer.py DESIGN.json [--step FILE]

Prints one JSON record: seconds a stage and in all (imports left out), volumes, validity. What it does not do:
thickness is measured in the section's plane, laws hold for a whole section, noses are flat with two fillets.
"""

from __future__ import annotations

import argparse
import json
import math
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from build123d import Axis, Compound, Edge, Face, Solid, Vector, Wire, export_step
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common, BRepAlgoAPI_Cut
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.BRepOffsetAPI import BRepOffsetAPI_ThruSections
from OCP.collections import List_TopoDS_Shape
from OCP.GProp import GProp_GProps
from OCP.TopoDS import TopoDS_Shape
from scipy.interpolate import BSpline, CubicSpline
from scipy.optimize import brentq
from scipy.spatial import cKDTree

PLANES = 11  # sections of a loft
BEYOND = 1.5  # mm that the lofts run past hub and tip
SECTOR = 30.0  # degrees of the annulus that are modelled
ROOM = 0.3  # mm straight between the two fillets of a nose


class Stopwatch:
    """Processor seconds a stage: what else the machine does must not count against OpenCASCADE."""

    def __init__(self):
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str):
        start = time.process_time()
        yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.process_time() - start


# -------------------------------------------------------------------------------------------------- design


def law(points, v: float) -> float:
    """A number, or control points [[v, value], ...] of a clamped uniform B-spline."""
    if isinstance(points, int | float):
        return float(points)
    p = np.array(points, float)
    degree = min(3, len(p) - 1)
    inner = np.linspace(0, 1, len(p) - degree + 1)
    curve = BSpline(np.concatenate([[0] * degree, inner, [1] * degree]), p, degree)
    if not p[0, 0] < v < p[-1, 0]:
        return float(p[0 if v <= p[0, 0] else -1, 1])
    return float(curve(brentq(lambda t: curve(t)[0] - v, 0, 1))[1])


def lengths(points: np.ndarray) -> np.ndarray:
    """Length along a polyline up to each of its points."""
    return np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


class Annulus:
    def __init__(self, space: dict):
        contours = [np.array(space[side], float) for side in ("hub", "shroud")]
        self._contours = [CubicSpline(s / s[-1], c) for c in contours for s in [lengths(c)]]

    def streamline(self, v: float, count: int) -> np.ndarray:
        hub, shroud = (contour(np.linspace(0, 1, count)) for contour in self._contours)
        return (1 - v) * hub + v * shroud

    def place(self, v: float, section: np.ndarray) -> np.ndarray:
        """Points (m, r theta) of the stream surface v in space; theta is measured from z."""
        line = self.streamline(v, 2001)
        x, r = (np.interp(section[:, 0], lengths(line), line[:, k]) for k in (0, 1))
        theta = section[:, 1] / r
        return np.column_stack([x, r * np.sin(theta), r * np.cos(theta)])

    def height(self) -> float:
        return float(np.linalg.norm(self.streamline(1, 3)[1] - self.streamline(0, 3)[1]))

    def between(self, low: float, high: float) -> TopoDS_Shape:
        """The solid of revolution between two stream surfaces, as much of it as the blade needs."""
        below, above = ([(float(x), 0.0, float(r)) for x, r in self.streamline(v, 21)] for v in (low, high))
        outline = Wire(
            [
                Edge.make_spline(below),
                Edge.make_line(below[-1], above[-1]),
                Edge.make_spline(above[::-1]),
                Edge.make_line(above[0], below[0]),
            ]
        ).rotate(Axis.X, -SECTOR / 2)
        return Solid.revolve(Face(outline), SECTOR, Axis.X).wrapped


class Blade:
    """Corresponding points of all sections; between them cubic in z, so that any plane z can be drawn."""

    def __init__(self, design: dict):
        self.annulus = Annulus(design["space"])
        sections = design["blade"]["sections"]
        loops = [np.array(s["pressure_side"][::-1] + s["suction_side"][1:], float) for s in sections]
        spans = [float(s["span"]) for s in sections]
        points = np.array([self.annulus.place(v, loop) for v, loop in zip(spans, loops, strict=True)])
        z = points[:, :, 2]
        self.nose = (
            len(sections[0]["pressure_side"]) - 1
        )  # the leading edge; the trailing edge is first and last
        self.planes = np.linspace(z[0].min() - BEYOND, z[-1].max() + BEYOND, PLANES)
        self.knots = lengths(points[len(points) // 2])  # the same for all planes: lofts then stay compact
        self._span = CubicSpline(z.mean(1), spans)
        self._columns = [CubicSpline(p[:, 2], p[:, :2]) for p in points.swapaxes(0, 1)]

    def span(self, z: float) -> float:
        return min(max(float(self._span(z)), 0.0), 1.0)

    def loop(self, z: float) -> np.ndarray:
        """Pressure side from the trailing to the leading edge, suction side back."""
        return np.array([column(z) for column in self._columns])


# ---------------------------------------------------------------------------------------- one plane's drawing


class Drawing:
    """Profile, camber line and chambers in one plane."""

    def __init__(self, blade: Blade, z: float):
        self.z, self.v = z, blade.span(z)
        loop = blade.loop(z)
        loop[-1] = loop[0]
        self.knots = blade.knots
        self.profile = CubicSpline(self.knots, loop, bc_type="periodic")
        self.edge = self.knots[blade.nose]
        self._inscribe()

    def _inscribe(self) -> None:
        """The camber line by inscribed circles: their contacts on both sides, centres and radii."""
        suction = np.linspace(self.edge, self.knots[-1], 302)[1:-1]
        pressure = np.linspace(0, self.edge, 3000)
        tree = cKDTree(self.profile(pressure))
        points, inward = self.profile(suction), self.inward(suction)
        low, high = np.zeros(len(points)), np.full(len(points), lengths(points)[-1])
        for _ in range(40):
            radius = (low + high) / 2
            fits = tree.query(points + radius[:, None] * inward)[0] >= radius
            low, high = np.where(fits, radius, low), np.where(fits, high, radius)
        centres = points + low[:, None] * inward
        touched = pressure[tree.query(centres)[1]]
        # The circles within a round nose say nothing: their centre stays, or their contact does.
        advance = np.linalg.norm(np.diff(centres, axis=0, prepend=np.nan), axis=1)
        moving = (advance > 0.3 * (suction[1] - suction[0])) & (np.diff(touched, prepend=np.inf) < 0)
        self.contacts = [touched[moving], suction[moving]]
        self.camber, self.height = centres[moving], 2 * low[moving]
        self.station = lengths(self.camber) + self.height[0] / 2
        self.length = self.station[-1] + self.height[-1] / 2

    def inward(self, at: np.ndarray) -> np.ndarray:
        """Normals into the blade, whichever way round the profile runs."""
        x, y = self.profile(self.knots).T
        turn = math.copysign(1.0, float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum()))
        slope = self.profile(at, 1)
        return turn * np.column_stack([-slope[:, 1], slope[:, 0]]) / np.linalg.norm(slope, axis=1)[:, None]

    def spatial(self, points) -> list[tuple[float, float, float]]:
        return [(float(x), float(y), self.z) for x, y in points]

    def outline(self) -> Wire:
        """Two splines that are tangent to each other at both edges."""
        edges = []
        for a, b in ((0.0, self.edge), (self.edge, self.knots[-1])):
            at = self.knots[(self.knots >= a) & (self.knots <= b)]
            slopes = [(float(x), float(y), 0.0) for x, y in self.profile(at[[0, -1]], 1)]
            points, parameters = self.spatial(self.profile(at)), [float(t) for t in at]
            edges.append(Edge.make_spline(points, tangents=slopes, parameters=parameters, scale=False))
        return Wire(edges)

    def cavity(self, suction: float, pressure: float, fillet: float) -> tuple[Face, list[float]]:
        """What the shell leaves of the profile, and the stations between which the fillets fit."""
        room = self.height - suction - pressure
        rows = np.nonzero(room > fillet)[0]
        step = max(1, len(rows) // 60)
        rows = np.append(rows[:-1:step], rows[-1])
        sides = zip(self.contacts, (pressure, suction), strict=True)
        lower, upper = (self.spatial(self.profile(at[rows]) + d * self.inward(at[rows])) for at, d in sides)
        outline = [
            Edge.make_spline(lower),
            Edge.make_line(lower[-1], upper[-1]),
            Edge.make_spline(upper[::-1]),
            Edge.make_line(upper[0], lower[0]),
        ]
        fits = np.nonzero(room > 2 * fillet + ROOM)[0]
        return Face(Wire(outline)), [float(self.station[fits[0]]), float(self.station[fits[-1]])]

    def wall_line(self, station: float, angle: float, shift: float) -> np.ndarray:
        """A line across the profile: through the camber line at the station, moved along its normal."""
        point = np.array([np.interp(station, self.station, c) for c in self.camber.T])
        ahead = np.array([np.interp(station + 0.1, self.station, c) for c in self.camber.T])
        tangent = (ahead - point) / np.linalg.norm(ahead - point)
        normal = np.array([-tangent[1], tangent[0]])
        up = np.mean(self.profile(self.contacts[1]) - self.camber, axis=0)
        normal *= math.copysign(1.0, normal @ up)
        along = math.cos(angle) * tangent + math.sin(angle) * normal
        across = math.sin(angle) * tangent - math.cos(angle) * normal
        reach = self.height.max()
        return point + shift * across + np.array([[-reach], [reach]]) * along

    def chamber(self, number: int, cooling: dict) -> list[Edge]:
        """Its eight edges, anticlockwise from the pressure side: sides, ends, and a fillet after each."""
        shell, walls = cooling["shell"], cooling["walls"]
        fillet = law(cooling["chambers"][number]["fillet_radius"], self.v)
        thickness = [law(shell[side], self.v) for side in ("suction_side", "pressure_side")]
        cavity, ends = self.cavity(*thickness, fillet)
        lines = [self.wall_line(station, math.pi / 2, 0.0) for station in ends]
        for k, sign in ((number - 1, 1), (number, -1)):
            if 0 <= k < len(walls):
                position, angle, width = (
                    law(walls[k][key], self.v) for key in ("position", "angle_deg", "thickness")
                )
                line = self.wall_line(position * self.length, math.radians(angle), sign * width / 2)
                lines[0 if sign > 0 else 1] = line
        (a, b), (c, d) = lines
        strip = Face(Wire.make_polygon(self.spatial([a, c, d, b]), close=True))
        face = Face(faces(boolean(BRepAlgoAPI_Common(), [cavity.wrapped], [strip.wrapped]))[0])
        face = face.fillet_2d(fillet, face.vertices())
        middle = Vector(*self.spatial([(c + d) / 2])[0])
        return from_nearest(anticlockwise(face), middle)


def anticlockwise(face: Face) -> list[Edge]:
    edges = [e if e.is_forward else e.reversed(reconstruct=True) for e in face.outer_wire().order_edges()]
    if face.normal_at().Z < 0:
        edges = [e.reversed(reconstruct=True) for e in reversed(edges)]
    return edges


def from_nearest(edges: list[Edge], point: Vector) -> list[Edge]:
    """The same ring, beginning with the straight side whose middle is nearest to the point."""
    rank = [(e.geom_type.name == "CIRCLE", (e.position_at(0.5) - point).length) for e in edges]
    first = min(range(len(edges)), key=rank.__getitem__)
    return edges[first:] + edges[:first]


def resampled(edge: Edge, count: int) -> Edge:
    """A spline of `count` points: lofts need the same kind of edge in all sections."""
    at = np.linspace(0, 1, count)
    slopes = [edge.tangent_at(t) * edge.length for t in (0, 1)]
    points = [tuple(edge.position_at(float(t))) for t in at]
    return Edge.make_spline(points, tangents=slopes, parameters=[float(t) for t in at], scale=False)


# ---------------------------------------------------------------------------------------------- OpenCASCADE


def loft(wires: list[Wire]) -> TopoDS_Shape:
    maker = BRepOffsetAPI_ThruSections(True, False, 1e-6)
    maker.CheckCompatibility(False)  # the sections correspond edge by edge
    for wire in wires:
        maker.AddWire(wire.wrapped)
    maker.Build()
    return maker.Shape()


def boolean(operation, arguments: list[TopoDS_Shape], tools: list[TopoDS_Shape]) -> TopoDS_Shape:
    for setter, shapes in ((operation.SetArguments, arguments), (operation.SetTools, tools)):
        sequence = List_TopoDS_Shape()
        for shape in shapes:
            sequence.Append(shape)
        setter(sequence)
    operation.Build()
    if not operation.IsDone():
        raise RuntimeError(f"{type(operation).__name__} failed")
    return operation.Shape()


def faces(shape: TopoDS_Shape) -> list[TopoDS_Shape]:
    return [face.wrapped for face in Compound(shape).faces()]


def volume(shape: TopoDS_Shape) -> float:
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties, 1e-5)
    return properties.Mass()


# ----------------------------------------------------------------------------------------------- modelling


def model(design: dict, watch: Stopwatch) -> tuple[TopoDS_Shape, list[TopoDS_Shape], TopoDS_Shape]:
    """The uncooled blade, the coolant of every chamber, and the metal."""
    cooling = design["cooling"]
    with watch.stage("sections"):
        blade = Blade(design)
        drawings = [Drawing(blade, float(z)) for z in blade.planes]
        outlines = [drawing.outline() for drawing in drawings]
    with watch.stage("blade"):
        blank = boolean(BRepAlgoAPI_Common(), [loft(outlines)], [blade.annulus.between(0, 1)])
    tip = 1 - cooling["shell"].get("tip", 0.0) / blade.annulus.height()
    coolant = []
    for number, chamber in enumerate(cooling["chambers"]):
        with watch.stage("chamber_sections"):
            rings = [drawing.chamber(number, cooling) for drawing in drawings]
            counts = [5 if e.geom_type.name == "CIRCLE" else max(4, round(e.length / 0.6)) for e in rings[0]]
            if any(len(ring) != len(counts) for ring in rings):
                raise RuntimeError(f"the sections of {chamber['name']} differ in their edges: no loft")
            wires = [Wire([resampled(e, n) for e, n in zip(ring, counts, strict=True)]) for ring in rings]
        with watch.stage("chambers"):
            limits = blade.annulus.between(*chamber.get("span", (0.0, tip)))
            coolant.append(boolean(BRepAlgoAPI_Common(), [loft(wires)], [limits]))
    with watch.stage("cut"):
        return blank, coolant, boolean(BRepAlgoAPI_Cut(), [blank], coolant)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("design", type=Path)
    parser.add_argument("--step", type=Path, help="write metal and coolant here")
    options = parser.parse_args()
    watch = Stopwatch()
    blank, coolant, metal = model(json.loads(options.design.read_text(encoding="utf-8")), watch)
    volumes = {"blank": volume(blank), "metal": volume(metal), "coolant": sum(map(volume, coolant))}
    parts = Compound([Compound(metal), *map(Compound, coolant)])
    record = {
        "seconds": {name: round(value, 4) for name, value in watch.seconds.items()},
        "total_s": round(sum(watch.seconds.values()), 4),
        "volume_mm3": {name: round(value, 4) for name, value in volumes.items()},
        "solids": len(parts.solids()),
        "faces": len(Compound(metal).faces()),
        "valid": BRepCheck_Analyzer(parts.wrapped).IsValid(),
    }
    if options.step:
        export_step(parts, options.step)
    print(json.dumps(record))


if __name__ == "__main__":
    main()
