"""Lofts of quads: rings of equally many vertices, each joined to the next."""

from collections import defaultdict

import numpy as np

from .meshes import Mesh


def rings(mesh: Mesh) -> np.ndarray | None:
    """The rings (n x m x 3, mm) of a tube of quads, from end to end; none if it is no such tube.

    What closes its ends, fans of triangles or polygons of more corners, is left out.
    """
    quads = [polygon for polygon in mesh.polygons if len(polygon) == 4]
    beside: dict[frozenset[int], list[int]] = defaultdict(list)
    for number, quad in enumerate(quads):
        for edge in _edges(quad):
            beside[edge].append(number)
    if any(len(numbers) > 2 for numbers in beside.values()):
        return None
    ends = _loops([edge for edge, numbers in beside.items() if len(numbers) == 1])
    if ends is None or len(ends) != 2 or len(ends[0]) != len(ends[1]):
        return None
    ring, around = ends[0], len(ends[0])
    found, used = [ring], set()
    while set(ring) != set(ends[1]):
        step = _next(ring, quads, beside, used)
        if step is None:
            return None
        ring = step
        found.append(ring)
    if len(used) != len(quads) or len({point for each in found for point in each}) != around * len(found):
        return None
    return mesh.points[np.array(found)]


def _edges(quad: tuple[int, ...]) -> list[frozenset[int]]:
    return [frozenset((a, b)) for a, b in zip(quad, quad[1:] + quad[:1], strict=True)]


def _loops(edges: list[frozenset[int]]) -> list[list[int]] | None:
    """The edges as closed lines that do not meet; none if they are none."""
    near: dict[int, list[int]] = defaultdict(list)
    for a, b in edges:
        near[a].append(b)
        near[b].append(a)
    if any(len(others) != 2 for others in near.values()):
        return None
    loops, left = [], set(near)
    while left:
        loop = [min(left)]
        before, here = None, loop[0]
        while True:
            step = near[here][0] if near[here][0] != before else near[here][1]
            if step == loop[0]:
                break
            loop.append(step)
            before, here = here, step
        left -= set(loop)
        loops.append(loop)
    return loops


def _next(ring: list[int], quads, beside, used: set[int]) -> list[int] | None:
    """The ring on the other side of the quads along ``ring``."""
    across: dict[int, int] = {}
    for a, b in zip(ring, ring[1:] + ring[:1], strict=True):
        numbers = [number for number in beside[frozenset((a, b))] if number not in used]
        if len(numbers) != 1:
            return None
        used.add(numbers[0])
        quad = quads[numbers[0]]
        at = quad.index(a)
        beyond = (
            (quad[at - 1], quad[at - 2]) if quad[(at + 1) % 4] == b else (quad[(at + 1) % 4], quad[at - 2])
        )
        for here, there in zip((a, b), beyond, strict=True):
            if across.setdefault(here, there) != there:
                return None
    return [across[point] for point in ring]
