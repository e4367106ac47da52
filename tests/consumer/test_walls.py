"""The walls that were asked for: distance of the chambers' sides to the blade's surface, measured in 3D."""

from __future__ import annotations

import pytest

import cli
import law
import wall
from span import Span

SIDES = ("suction_side", "pressure_side")
LIMIT_MM, LIMIT = 0.01, 0.01  # either will do
ENDS = 0.03  # of the span, left out at hub and tip


def asked(design: dict, chamber: dict, side: str) -> law.Law | None:
    """The law of the shell for one side of a chamber; the chamber's own one goes first."""
    shell = {**design["cooling"].get("shell", {}), **chamber.get("shell", {})}
    return shell.get(side)


@pytest.mark.parametrize("side", SIDES)
def test_shell_thickness(model: cli.Model, library, side: str):
    chambers = model.design.get("cooling", {}).get("chambers", [])
    if not chambers:
        pytest.skip("no chambers in this design")
    metal = library.products(model.file("metal", "step"))[0]
    span = Span(model.design["space"])
    for chamber in chambers:
        thickness = asked(model.design, chamber, side)
        assert thickness is not None, f"no law for the {side}"
        faces = metal.named(f"chamber/{chamber['name']}/{side}")
        assert faces, f"{chamber['name']} has no {side}"
        # Near the noses the nearest surface is the leading or trailing edge, where the laws are blended.
        found = [s for s in wall.sample(metal, faces) if s.nearest == f"blade/{side}"]
        found = [(s, v) for s in found if ENDS < (v := span.fraction(s.point)) < 1 - ENDS]
        assert len(found) >= 50, f"only {len(found)} points on {chamber['name']} {side}"
        wrong = []
        for s, v in found:
            expected = law.value(thickness, v)
            if abs(s.distance - expected) > max(LIMIT_MM, LIMIT * expected):
                wrong.append(
                    (abs(s.distance - expected), f"v {v:.3f}: {s.distance:.4f} mm, asked {expected:.4f}")
                )
        assert not wrong, f"{chamber['name']} {side}: {len(wrong)} of {len(found)} off, worst {max(wrong)[1]}"
