"""Designs to begin with for blades that are there already: the space that they stand in, a shell, a chamber.

Hub and shroud are laid so that the blade reaches past both. Points are x, y, z in mm.
"""

import math
from collections.abc import Sequence

Point = Sequence[float]

#: Hub and shroud keep so much of the blade's height from its ends, and go so much of its length past its
#: edges.
INSIDE, PAST = 0.02, 0.35
#: A blade whose inner radius is less than this part of its outer one does not stand round the machine's axis.
LEAST_RADIUS_RATIO = 0.15


def design(name: str, points: Sequence[Point], within: dict, source: dict) -> dict:
    """A design with one chamber for the blade that ``source`` describes, that has ``points`` all over it and
    stands in the space ``within``.
    """
    thickness = _shell(points)
    return {
        "format": "coolinggen/1",
        "name": plain(name),
        "space": within,
        "blade": source,
        "cooling": {
            "shell": {"suction_side": thickness, "pressure_side": thickness, "tip": thickness},
            "chambers": [{"name": "main", "fillet_radius": round(thickness / 2, 3)}],
        },
    }


def plain(name: str) -> str:
    """The name with nothing in it but letters, digits and underscores, as a design's has to be."""
    return "".join(c if c.isascii() and c.isalnum() else "_" for c in name).strip("_") or "blade"


def _shell(points: Sequence[Point]) -> float:
    """A shell that leaves room for a chamber: a fortieth of the blade's length along the flow, rounded."""
    xs = [x for x, _, _ in points]
    ys = [y for _, y, _ in points]
    length = math.hypot(max(xs) - min(xs), max(ys) - min(ys))
    return float(f"{max(length / 40, 0.05):.2g}")


def space(points: Sequence[Point], ends: tuple[Sequence[Point], Sequence[Point]] | None = None) -> dict:
    """Where a blade with these points stands: between two cones round the x axis that both lie within it,
    or, if it is no blade of such a machine, between two planes across z.

    ``ends`` are the points of its two ends, where they are known; else they are sought among all.
    """
    radii = [math.hypot(y, z) for _, y, z in points]
    if min(radii) < LEAST_RADIUS_RATIO * max(radii):
        low, high = min(z for _, _, z in points), max(z for _, _, z in points)
        inside = INSIDE * (high - low)
        return {"kind": "linear", "z0": low + inside, "height": high - low - 2 * inside}
    xr = _radial(points)
    begin, end = min(x for x, _ in xr), max(x for x, _ in xr)
    past = PAST * (end - begin)
    inner, outer = sorted((_radial(end) for end in ends), key=_mean_radius) if ends else (xr, xr)
    hub, shroud = _bound(inner, lower=True), _bound(outer, lower=False)
    ends = (begin - past, end + past)
    inside = INSIDE * (max(radii) - min(radii))
    return {
        "kind": "annular",
        "hub": [[x, hub[0] * x + hub[1] + inside] for x in ends],
        "shroud": [[x, shroud[0] * x + shroud[1] - inside] for x in ends],
    }


def _radial(points: Sequence[Point]) -> list[tuple[float, float]]:
    return [(x, math.hypot(y, z)) for x, y, z in points]


def _mean_radius(xr: list[tuple[float, float]]) -> float:
    return sum(r for _, r in xr) / len(xr)


def _bound(xr: list[tuple[float, float]], *, lower: bool) -> tuple[float, float]:
    """Slope and height of the line over x that leaves the whole end of a blade on its outer side: the
    tightest bound of the ends' radii in slices of x.
    """
    begin, end = min(x for x, _ in xr), max(x for x, _ in xr)
    width = (end - begin) / 12 or 1.0
    pick = min if lower else max
    slices: dict[int, list[tuple[float, float]]] = {}
    for x, r in xr:
        slices.setdefault(min(int((x - begin) / width), 11), []).append((x, r))
    ends = [pick(part, key=lambda p: p[1]) for part in slices.values() if len(part) > 2]
    n = len(ends)
    mean_x, mean_r = sum(x for x, _ in ends) / n, sum(r for _, r in ends) / n
    spread = sum((x - mean_x) ** 2 for x, _ in ends) or 1.0
    slope = sum((x - mean_x) * (r - mean_r) for x, r in ends) / spread
    off = [r - slope * x for x, r in ends]
    return slope, max(off) if lower else min(off)
