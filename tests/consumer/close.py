"""How close numbers have to be, in one place."""

from __future__ import annotations

import numpy as np

VOLUME = 2e-5  # relative: the report, OpenCASCADE's rules and the curved mesh
PARTITION = 1e-7  # relative: metal and coolant make up the uncooled blade
TOLERANCE_MM = 1e-6  # of any vertex, edge or face
BOX_MM = 0.01  # bounding boxes as other programs find them
CHORD_MM = 0.02  # of exported meshes, the default of `generate`
COLOUR = 0.005  # of 1; colours travel as 8 bits in places


def relative(found: float, expected: float) -> float:
    return abs(found - expected) / abs(expected)


def assert_volume(found: float, expected: float, what: str, limit: float = VOLUME) -> None:
    off = relative(found, expected)
    assert off <= limit, (
        f"{what}: {found:.6f} mm3, the report says {expected:.6f}, {off:.2e} off (limit {limit:.0e})"
    )


def assert_box(found, expected: list[list[float]], what: str, limit: float = BOX_MM) -> None:
    off = np.abs(np.array(found) - np.array(expected)).max()
    assert off <= limit, f"{what}: box {np.array(found).tolist()}, the report says {expected}"
