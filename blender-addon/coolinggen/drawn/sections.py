"""Sections of a blade on the stream surfaces of the space that it stands in."""

import numpy as np

from .meshes import Mesh

#: Cuts of a mesh that has no rings, and how far past hub and shroud the outermost lie, as a span fraction.
CUTS, PAST = 15, 0.01
#: A point of a cut that is nearer to the last, as a part of the gaps beside, is left out.
NEAR = 0.35
#: How far the blade may leave the points of cuts, which are a little uneven: a part of the chord, within
#: limits in mm.
UNEVEN, LEAST_UNEVEN, MOST_UNEVEN = 2.5e-4, 0.002, 0.1
#: Rings lie in a plane where they leave it by less than this part of the blade's height.
FLAT = 1e-5


class Stream:
    """The stream surfaces of a space that ``client.begin`` has laid: planes, or cones between two lines."""

    def __init__(self, space: dict):
        self.annular = space["kind"] == "annular"
        self._theta: float | None = None
        if self.annular:
            self._hub, self._shroud = np.array(space["hub"]), np.array(space["shroud"])
        else:
            self._z0, self._height = space["z0"], space["height"]

    def span(self, points: np.ndarray) -> np.ndarray:
        """Span fractions of points (... x 3)."""
        if not self.annular:
            return (points[..., 2] - self._z0) / self._height
        (x0, hub0), (x1, hub1) = self._hub
        (_, shroud0), (_, shroud1) = self._shroud
        along = (points[..., 0] - x0) / (x1 - x0)
        hub, shroud = hub0 + along * (hub1 - hub0), shroud0 + along * (shroud1 - shroud0)
        return (np.hypot(points[..., 1], points[..., 2]) - hub) / (shroud - hub)

    def flat(self, points: np.ndarray, span: float) -> np.ndarray:
        """Coordinates (n x 2) of points on the surface of a span fraction: along the meridian, and around."""
        if not self.annular:
            return points[:, :2]
        start, end = self._hub + span * (self._shroud - self._hub)
        along = (points[:, 0] - start[0]) / (end[0] - start[0]) * np.hypot(*(end - start))
        theta = np.arctan2(points[:, 1], points[:, 2])
        # All angles are counted from one side of the machine, the blade's.
        if self._theta is None:
            self._theta = float(np.arctan2(np.sin(theta).mean(), np.cos(theta).mean()))
        theta = self._theta + (theta - self._theta + np.pi) % (2 * np.pi) - np.pi
        return np.stack([along, np.hypot(points[:, 1], points[:, 2]) * theta], axis=1)

    @property
    def way(self) -> str:
        """Which way the span is."""
        return "away from the x axis" if self.annular else "along z"


def of_rings(rings, stream: Stream) -> dict:
    """The design's ``sections`` through rings of points (m x 3 each, mm).

    Raises ValueError if they do not follow each other along the span.
    """
    rings = sorted(rings, key=lambda ring: stream.span(ring).mean())
    middle = [ring[:, 2].mean() for ring in rings]
    height = max(ring[:, 2].max() for ring in rings) - min(ring[:, 2].min() for ring in rings)
    flat = all(np.abs(ring[:, 2] - z).max() <= FLAT * height for ring, z in zip(rings, middle, strict=True))
    alike = len({len(ring) for ring in rings}) == 1
    # Round the machine's axis sections are better laid onto stream surfaces along lines from ring to ring.
    if flat and not (stream.annular and alike):
        if min(np.diff(middle)) <= FLAT * height:
            raise ValueError(f"two sections lie in one plane: they must follow each other {stream.way}")
        return _source(
            {"z": z, "points": ring[:, :2].tolist()} for ring, z in zip(rings, middle, strict=True)
        )
    if not alike:
        raise ValueError("curves that do not lie in planes across z need equally many points")
    net = _aligned(rings)
    spans = stream.span(net)
    if not (np.diff(spans, axis=0) > 0).all():
        raise ValueError(f"the sections do not follow each other {stream.way}")
    ends = spans[0].max(), spans[-1].min()
    if ends[0] >= ends[1]:
        raise ValueError(f"the sections lie askew: none reaches all around at one place {stream.way}")
    # Each ring has its own section where it is one; else there are some more, for what a ring is bent.
    count = len(rings) if np.ptp(spans, axis=1).max() < FLAT else 2 * len(rings) + 1
    made = []
    for span in np.linspace(*ends, count) if count > len(rings) else spans.mean(axis=1):
        points = np.array([_at(spans[:, k], net[:, k], span) for k in range(net.shape[1])])
        made.append({"span": float(span), "points": stream.flat(points, span).tolist()})
    return _source(made)


def of_cuts(mesh: Mesh, stream: Stream) -> dict:
    """The design's ``sections`` where stream surfaces cut a mesh.

    Raises ValueError if one cuts it not in a single closed line.
    """
    made, chords = [], []
    for span in np.linspace(-PAST, 1.0 + PAST, CUTS):
        line = _cut(mesh, stream, span)
        flat = stream.flat(line, span)
        made.append({"span": float(span), "points": flat.tolist()})
        chords.append(np.ptp(flat, axis=0).max())
    tolerance = float(np.clip(UNEVEN * max(chords), LEAST_UNEVEN, MOST_UNEVEN))
    return {**_source(made), "tolerance": tolerance}


def _source(sections) -> dict:
    return {"kind": "sections", "sections": list(sections)}


def _aligned(rings: list[np.ndarray]) -> np.ndarray:
    """Rings of equally many points turned so that the points of one number lie nearest each other."""
    made = [rings[0]]
    for ring in rings[1:]:
        turned = [np.roll(way, -k, axis=0) for way in (ring, ring[::-1]) for k in range(len(ring))]
        made.append(min(turned, key=lambda each: np.square(each - made[-1]).sum()))
    return np.array(made)


def _at(spans: np.ndarray, points: np.ndarray, span: float) -> np.ndarray:
    """The point at a span fraction on the curve through the four points nearest to it (Lagrange)."""
    count = min(4, len(spans))
    first = int(np.clip(np.searchsorted(spans, span) - count // 2, 0, len(spans) - count))
    near = slice(first, first + count)
    weights = [
        np.prod([(span - b) / (a - b) for j, b in enumerate(spans[near]) if j != i])
        for i, a in enumerate(spans[near])
    ]
    return np.array(weights) @ points[near]


def _cut(mesh: Mesh, stream: Stream, span: float) -> np.ndarray:
    """The closed line (n x 3) in which a stream surface cuts a mesh that is bent between its vertices."""
    edges = mesh.edges
    above = stream.span(mesh.points) > span
    crossed = above[edges.ends[:, 0]] != above[edges.ends[:, 1]]
    sides = edges.of_triangles[crossed[edges.of_triangles].any(axis=1)]
    loops = _chains([pair for pair in (side[crossed[side]].tolist() for side in sides) if len(pair) == 2])
    if len(loops) != 1:
        where = f"at the span fraction {span:.2f} ({stream.way})"
        raise ValueError(f"{where} the mesh is cut in {len(loops)} closed lines, a blade in one")
    legs = edges.curves[loops[0]]
    beyond = above[edges.ends[loops[0], 1]]
    low, high = np.zeros(len(legs)), np.ones(len(legs))
    for _ in range(40):
        half = (low + high) / 2
        past = (stream.span(_bezier(legs, half)) > span) == beyond
        low, high = np.where(past, low, half), np.where(past, half, high)
    line = _bezier(legs, (low + high) / 2)
    # Edges that meet in a point on the cut, or near it, give it once each.
    apart = np.linalg.norm(line - np.roll(line, 1, axis=0), axis=1)
    return line[apart > NEAR * np.maximum(np.roll(apart, 1), np.roll(apart, -1))]


def _bezier(legs: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Points at the parameters ``at`` of cubic Bezier curves (n x 4 x 3)."""
    s, t = (1 - at)[:, None], at[:, None]
    return s**3 * legs[:, 0] + 3 * s**2 * t * legs[:, 1] + 3 * s * t**2 * legs[:, 2] + t**3 * legs[:, 3]


def _chains(segments: list[list[int]]) -> list[list[int]]:
    """Segments between numbered points as closed lines; open ones are not among them."""
    near: dict[int, list[int]] = {}
    for a, b in segments:
        near.setdefault(a, []).append(b)
        near.setdefault(b, []).append(a)
    loops, left = [], set(near)
    while left:
        first = here = left.pop()
        loop, before = [first], None
        while True:
            step = next((each for each in near[here] if each != before), None)
            if len(near[here]) != 2 or step is None:
                loop = []
                break
            if step == first:
                break
            loop.append(step)
            left.discard(step)
            before, here = here, step
        if loop:
            loops.append(loop)
    return loops
