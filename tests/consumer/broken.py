"""Designs that must be refused: what is changed in a sample, and where the fault has to point.

A fault may point at the place itself, below it, or at what holds it directly.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from edits import INFINITE, NAN, REMOVE


class Case(NamedTuple):
    name: str
    sample: str
    changes: dict[str, Any]
    points_at: tuple[str, ...] | None = None  # default: the places changed

    @property
    def places(self) -> tuple[str, ...]:
        return self.points_at if self.points_at is not None else tuple(self.changes)


SHELL, WALLS, CHAMBERS = "/cooling/shell", "/cooling/walls", "/cooling/chambers"
SECTIONS, SPACE = "/blade/sections", "/space"


def swapped(items: list) -> list:
    return [items[1], items[0], *items[2:]]


def doubled_point(points: list) -> list:
    middle = len(points) // 2
    return [*points[:middle], points[middle], *points[middle:]]


def looped(points: list) -> list:
    """Two points far apart change places, so that the curve crosses itself."""
    a, b = len(points) // 3, 2 * len(points) // 3
    result = list(points)
    result[a], result[b] = points[b], points[a]
    return result


def stacked(holes: list[dict]) -> list[dict]:
    """The second hole where the first one is."""
    return [holes[0], {**holes[0], "name": holes[1]["name"]}, *holes[2:]]


def rotor(name: str, changes: dict[str, Any], points_at: tuple[str, ...] | None = None) -> Case:
    return Case(name, "rotor", changes, points_at)


def c3x(name: str, changes: dict[str, Any], points_at: tuple[str, ...] | None = None) -> Case:
    return Case(name, "c3x", changes, points_at)


FIELDS = [
    rotor("no format", {"/format": REMOVE}),
    rotor("a format of the future", {"/format": "coolinggen/99"}),
    rotor("no name", {"/name": REMOVE}),
    rotor("empty name", {"/name": ""}),
    rotor("a name that leaves the folder", {"/name": "../rotor"}),
    rotor("no space", {"/space": REMOVE}),
    rotor("no blade", {"/blade": REMOVE}),
    rotor("unknown field at the top", {"/cooking": {}}),
    rotor("unknown field in cooling", {"/cooling/film_rovs": []}),
    rotor("unknown field in the shell", {f"{SHELL}/sucktion_side": 1.0}),
    rotor("unknown field in a chamber", {f"{CHAMBERS}/0/fillet": 0.5}),
    rotor("unknown kind of space", {f"{SPACE}/kind": "toroidal"}),
    rotor("unknown kind of blade", {"/blade/kind": "wooden"}),
]

TYPES = [
    rotor("thickness as text", {f"{SHELL}/suction_side": "1.2"}),
    rotor("thickness null", {f"{SHELL}/suction_side": None}),
    rotor("chambers as an object", {CHAMBERS: {}}),
    rotor("walls as a number", {WALLS: 3}),
    rotor("wall position as text", {f"{WALLS}/0/position": "front"}),
    rotor("name as a number", {"/name": 7}),
    rotor("sections null", {SECTIONS: None}),
    rotor("a point with one coordinate", {f"{SECTIONS}/0/suction_side/0": [1.0]}),
    rotor("a point with three coordinates", {f"{SECTIONS}/0/suction_side/0": [1.0, 2.0, 3.0]}),
    rotor("a law with a triple", {f"{SHELL}/suction_side": [[0, 1.2, 3], [1, 1.0]]}),
]

NUMBERS = [
    rotor("thickness NaN", {f"{SHELL}/suction_side": NAN}, ("",)),
    rotor("a point at infinity", {f"{SECTIONS}/0/suction_side/0": [INFINITE, 0]}, ("",)),
    rotor("thickness too great for a double", {f"{SHELL}/suction_side": 10**400}, ("",)),
    rotor("negative thickness", {f"{SHELL}/suction_side": -1.2}),
    rotor("zero thickness", {f"{SHELL}/pressure_side": 0}),
    rotor("thickness law that dips below zero", {f"{SHELL}/suction_side": [[0, 1.2], [0.5, -6], [1, 1.2]]}),
    rotor("empty law", {f"{SHELL}/suction_side": []}),
    rotor("law that runs backwards", {f"{SHELL}/suction_side": [[1, 1.2], [0, 1.0]]}),
    rotor("negative wall thickness", {f"{WALLS}/0/thickness": -1}),
    rotor("wall outside the camber", {f"{WALLS}/0/position": 1.7}),
    rotor("wall along the camber", {f"{WALLS}/0/angle_deg": 0}),
    rotor("negative fillet", {f"{CHAMBERS}/0/fillet_radius": -0.6}),
    rotor("chamber upside down", {f"{CHAMBERS}/0/span": [0.9, 0.1]}),
    rotor("chamber beyond the shroud", {f"{CHAMBERS}/0/span": [0.0, 1.4]}),
]

GEOMETRY = [
    rotor(
        "thicknesses that cross",
        {f"{SHELL}/suction_side": 40, f"{SHELL}/pressure_side": 40},
        (SHELL, CHAMBERS),
    ),
    rotor("walls out of order", {WALLS: swapped}),
    rotor("walls at one place", {f"{WALLS}/1/position": 0.31, f"{WALLS}/0/position": 0.31}, (WALLS,)),
    rotor(
        "walls that cross in the blade though their positions are in order",
        {
            f"{WALLS}/0/position": 0.35,
            f"{WALLS}/0/angle_deg": 150,
            f"{WALLS}/1/position": 0.45,
            f"{WALLS}/1/angle_deg": 30,
        },
        (f"{CHAMBERS}/1", WALLS),
    ),
    rotor("a wall thicker than its chambers", {f"{WALLS}/0/thickness": 60}, (WALLS, CHAMBERS)),
    rotor("fillet larger than the chamber", {f"{CHAMBERS}/0/fillet_radius": 50}),
    rotor("two walls of one name", {f"{WALLS}/1/name": "twin", f"{WALLS}/0/name": "twin"}, (WALLS,)),
    rotor(
        "two chambers of one name", {f"{CHAMBERS}/1/name": "twin", f"{CHAMBERS}/0/name": "twin"}, (CHAMBERS,)
    ),
    rotor("a chamber too many", {f"{CHAMBERS}/-": {"name": "spare"}}, (CHAMBERS, WALLS)),
    rotor("hub above the shroud", {f"{SPACE}/hub": [[-99, 900], [99, 900]]}, (SPACE,)),
    rotor("hub of one point", {f"{SPACE}/hub": [[0, 250]]}),
    rotor("hub below the axis", {f"{SPACE}/hub": [[0, -250], [40, -250]]}),
]

SECTION_SHAPES = [
    rotor("no sections", {SECTIONS: []}),
    rotor("empty side", {f"{SECTIONS}/0/suction_side": []}),
    rotor("a side of two points", {f"{SECTIONS}/0/suction_side": lambda points: points[:2]}),
    rotor("the same point all along", {f"{SECTIONS}/0/suction_side": [[1.0, 1.0]] * 40}),
    rotor("a point twice", {f"{SECTIONS}/0/suction_side": doubled_point}),
    rotor("a side that crosses itself", {f"{SECTIONS}/0/suction_side": looped}),
    rotor("sections out of order", {SECTIONS: swapped}),
    rotor("two sections at one span", {f"{SECTIONS}/1/span": 0.0, f"{SECTIONS}/0/span": 0.0}, (SECTIONS,)),
    rotor(
        "points as large as a town", {f"{SECTIONS}/0/suction_side": [[1e300, k * 1e299] for k in range(40)]}
    ),
]

HOLES = "/cooling/radial_holes"

RADIAL_HOLES = [
    c3x("negative diameter", {f"{HOLES}/0/diameter": -1}),
    c3x("no diameter", {f"{HOLES}/0/diameter": REMOVE}),
    c3x("a hole wider than the vane", {f"{HOLES}/0/diameter": 90}),
    c3x("two holes of one name", {f"{HOLES}/1/name": "twin", f"{HOLES}/0/name": "twin"}, (HOLES,)),
    c3x("two holes at one place", {HOLES: stacked}),
    c3x("unknown field in a hole", {f"{HOLES}/0/radius": 3}),
]

CASES = FIELDS + TYPES + NUMBERS + GEOMETRY + SECTION_SHAPES + RADIAL_HOLES

SEVERAL = {
    f"{SHELL}/suction_side": -1.2,
    f"{WALLS}/0/thickness": -1,
    f"{CHAMBERS}/0/fillet_radius": -0.6,
    f"{CHAMBERS}/1/span": [0.9, 0.1],
}

NOT_JSON = {
    "nothing": b"",
    "a word": b"blade",
    "a list": b"[]",
    "a number": b"42",
    "cut short": None,  # the sample's first half
    "not UTF-8": b'{"format": "\xff\xfe"}',
    "very deep": b"[" * 200_000,
}
