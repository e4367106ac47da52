"""The span fraction v of a point in space: 0 on the hub, 1 on the shroud."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline, CubicSpline
from scipy.optimize import least_squares


class Span:
    """The space of a design: planes of a linear cascade, or streamlines between hub and shroud."""

    def __init__(self, space: dict):
        self._space = space
        if space["kind"] == "annular":
            lines = [(0.0, space["hub"]), (1.0, space["shroud"])]
        else:
            lines = [(line["v"], line["contour"]) for line in space.get("streamlines", [])]
        self._fractions = [v for v, _ in lines]
        self._contours = [_contour(line) for _, line in lines]

    def fraction(self, point: np.ndarray) -> float:
        if self._space["kind"] == "linear":
            return (point[2] - self._space.get("z0", 0.0)) / self._space["height"]
        target = np.array([point[0], np.hypot(point[1], point[2])])
        return float(least_squares(lambda sv: self._place(*sv) - target, [0.5, 0.5], xtol=1e-12).x[1])

    def _place(self, s: float, v: float) -> np.ndarray:
        """The point (x, r) of the streamline v at its station s: across the streamlines at equal stations."""
        across = np.array([contour(s) for contour in self._contours])
        if len(across) == 2:
            return (1 - v) * across[0] + v * across[1]
        return CubicSpline(self._fractions, across)(v)


def _contour(contour):
    """A contour over s in [0, 1], straight beyond its ends: points by fraction of length, or a B-spline."""
    if isinstance(contour, dict):
        knots = np.array(contour["knots"], float)
        knots = (knots - knots[0]) / (knots[-1] - knots[0])
        curve = BSpline(knots, np.array(contour["points"], float), contour["degree"])
    else:
        points = np.array(contour, float)
        s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        straight = len(points) == 2
        curve = BSpline([0, 0, 1, 1], points, 1) if straight else CubicSpline(s / s[-1], points)

    def place(s: float) -> np.ndarray:
        inside = min(max(s, 0.0), 1.0)
        return curve(inside) + (s - inside) * curve(inside, 1)

    return place
