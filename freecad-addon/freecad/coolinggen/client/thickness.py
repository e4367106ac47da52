"""The scale of colours that shows the thickness of a wall."""

import math
from collections.abc import Sequence

Color = tuple[float, float, float]

#: Colours from the thinnest to the thickest wall, red, green and blue as a screen shows them.
SCALE: tuple[Color, ...] = (
    (0.84, 0.19, 0.15),
    (0.99, 0.68, 0.38),
    (1.0, 1.0, 0.75),
    (0.65, 0.85, 0.42),
    (0.17, 0.51, 0.73),
)
NONE: Color = (0.6, 0.6, 0.6)  #: Where there is no wall to the outside.


def span(walls: Sequence[float]) -> tuple[float, float]:
    """Least and greatest thickness of the colours, for thicknesses in growing order: a twentieth of them may
    be above the scale.

    Raises ValueError if there are none.
    """
    if not len(walls):
        raise ValueError("the blade has no passages")
    return walls[0], max(walls[int(0.95 * (len(walls) - 1))], walls[0] + 1e-6)


def color(value: float, low: float, high: float) -> Color:
    """The colour of a thickness on the scale from ``low`` to ``high``."""
    if not math.isfinite(value):
        return NONE
    place = min(max((value - low) / (high - low), 0.0), 1.0) * (len(SCALE) - 1)
    k = min(int(place), len(SCALE) - 2)
    return tuple(a + (b - a) * (place - k) for a, b in zip(SCALE[k], SCALE[k + 1], strict=True))
