"""The laws' own evaluator and the span fraction, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import BSpline

import law
from span import Span


def test_a_number_is_the_same_everywhere():
    assert law.value(1.2, 0.3) == 1.2


def test_two_points_make_a_line():
    assert law.value([[0, 1.0], [1, 2.0]], 0.25) == pytest.approx(1.25)


def test_many_points_make_a_clamped_cubic():
    points = [[0, 1.2], [0.1, 1.5], [0.6, 0.8], [0.8, 1.1], [1, 1.0]]
    curve = BSpline([0, 0, 0, 0, 0.5, 1, 1, 1, 1], np.array(points, float), 3)
    for t in np.linspace(0, 1, 21):
        v, value = curve(t)
        assert law.value(points, v) == pytest.approx(value, abs=1e-9)


def test_span_fraction_between_cones():
    space = {"kind": "annular", "hub": [[0, 250], [40, 252]], "shroud": [[0, 305], [40, 315]]}
    span = Span(space)
    for v in (0.0, 0.3, 1.0):
        r = (1 - v) * 251 + v * 310
        assert span.fraction(np.array([20, 0.6 * r, 0.8 * r])) == pytest.approx(v, abs=1e-9)
