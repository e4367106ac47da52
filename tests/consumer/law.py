"""A law over the span as designs write it: a number, or control points [[v, value], ...] of a B-spline."""

from __future__ import annotations

import numpy as np

Law = float | list[list[float]]


def value(law: Law, v: float) -> float:
    """The curve's value where its abscissa is v: clamped uniform knots, cubic if there are points enough."""
    if isinstance(law, int | float):
        return float(law)
    points = np.array(law, float)
    low, high = 0.0, 1.0
    if v <= points[0, 0]:
        return float(points[0, 1])
    if v >= points[-1, 0]:
        return float(points[-1, 1])
    for _ in range(60):  # the abscissae rise, so the one parameter is found by halving
        middle = (low + high) / 2
        low, high = (middle, high) if _curve(points, middle)[0] < v else (low, middle)
    return float(_curve(points, (low + high) / 2)[1])


def _curve(points: np.ndarray, t: float) -> np.ndarray:
    """De Boor's algorithm."""
    degree = min(3, len(points) - 1)
    spans = len(points) - degree
    knots = np.concatenate([np.zeros(degree), np.linspace(0, 1, spans + 1), np.ones(degree)])
    k = min(int(np.searchsorted(knots, t, side="right")) - 1, len(points) - 1)
    d = points[k - degree : k + 1].copy()
    for r in range(1, degree + 1):
        for j in range(degree, r - 1, -1):
            i = j + k - degree
            a = (t - knots[i]) / (knots[i + degree - r + 1] - knots[i])
            d[j] = (1 - a) * d[j - 1] + a * d[j]
    return d[degree]
