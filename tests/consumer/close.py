"""How close numbers have to be, in one place."""

from __future__ import annotations

import numpy as np

VOLUME = 2e-5  # relative: the report, OpenCASCADE's rules and the curved mesh
PARTITION = 1e-7  # relative: metal and coolant make up the uncooled blade
TOLERANCE_MM = 1e-6  # of any vertex, edge or face
BOX_MM = 0.01  # by how much less a box may be than the exact one
BOX_OVERHANG = 0.01  # of the diagonal: what a face's rectangle of parameters may reach beyond its borders
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


def assert_held(found, expected: list[list[float]], what: str) -> None:
    """OpenCASCADE bounds the rectangle of each face's parameters, which may reach beyond the face's borders:
    its box holds the exact one, and is not much greater. How tight the report's box is, the meshes tell
    (test_meshes)."""
    (low, high), exact = np.array(found), np.array(expected)
    beyond = np.maximum(exact[0] - low, high - exact[1]).max()
    short = np.maximum(low - exact[0], exact[1] - high).max()
    allowed = BOX_OVERHANG * np.linalg.norm(exact[1] - exact[0])
    assert short <= BOX_MM and beyond <= allowed, (
        f"{what}: box {np.array(found).tolist()}, the report says {expected}"
    )
