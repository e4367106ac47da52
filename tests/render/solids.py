"""Exported meshes as VTK surfaces: one for each solid, smooth within a face and sharp between faces."""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import pyvista as pv

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "consumer"))
import meshes

SHARP = 20.0  # degrees between two faces that are drawn with a line between them


@dataclass(frozen=True)
class Solid:
    name: str
    regions: list[meshes.Region]  # with normals

    @property
    def is_metal(self) -> bool:
        """Blades, and the walls of a row."""
        return self.name.split("/")[0] in ("metal", "hub", "shroud")

    @property
    def is_shroud(self) -> bool:
        return self.name == "shroud"

    @property
    def is_insert(self) -> bool:
        return self.name.split("/")[0] == "insert"

    def only(self, prefix: str) -> Solid:
        """The faces whose names begin so; all, if none does."""
        chosen = [region for region in self.regions if region.name.startswith(prefix)]
        return Solid(self.name, chosen or self.regions)

    @cached_property
    def corners(self) -> np.ndarray:
        return np.concatenate([region.corners for region in self.regions])

    @cached_property
    def normals(self) -> np.ndarray:
        return np.concatenate([region.normals for region in self.regions])

    @cached_property
    def shaded(self) -> pv.PolyData:
        """For the eye: every triangle on its own, with the normals of the exact surfaces."""
        return together([shaded(region) for region in self.regions])

    def shaded_below(self, plane: dict) -> pv.PolyData:
        """The same, cut off: face by face, for cutting takes points at one place for one, normals or not."""
        pieces = [shaded(region).clip(**plane) for region in self.regions]
        return together([piece for piece in pieces if piece.n_cells])

    @cached_property
    def closed(self) -> pv.PolyData:
        """Welded, for cutting."""
        return polydata(*welded(self.corners))

    @cached_property
    def edges(self) -> pv.PolyData:
        """Sides between two triangles of different faces that meet at an angle."""
        points, triangles = welded(self.corners)
        face = np.repeat(np.arange(len(self.regions)), [len(region.corners) for region in self.regions])
        sides = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
        middles = np.concatenate([self.normals[:, i] + self.normals[:, (i + 1) % 3] for i in range(3)])
        middles /= np.linalg.norm(middles, axis=1)[:, None]
        order = np.lexsort(np.sort(sides, axis=1).T)
        first, second = order[0::2], order[1::2]  # the mesh is closed: every side comes twice
        kept = face[first % len(face)] != face[second % len(face)]
        kept &= (middles[first] * middles[second]).sum(1) < np.cos(np.radians(SHARP))
        lines = np.column_stack([np.full(kept.sum(), 2), sides[first[kept]]])
        return pv.PolyData(points, lines=lines.ravel())


def welded(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    points, index = np.unique(np.round(corners.reshape(-1, 3), 5), axis=0, return_inverse=True)
    return points, index.reshape(-1, 3)


def shaded(region: meshes.Region) -> pv.PolyData:
    corners = region.corners.reshape(-1, 3)
    surface = polydata(corners, np.arange(len(corners)).reshape(-1, 3))
    surface.point_data.active_normals = region.normals.reshape(-1, 3).astype(np.float32)
    return surface


def together(pieces: list[pv.PolyData]) -> pv.PolyData:
    return pieces[0].append_polydata(*pieces[1:]) if len(pieces) > 1 else pieces[0]


def polydata(points: np.ndarray, triangles: np.ndarray) -> pv.PolyData:
    return pv.PolyData(points, np.column_stack([np.full(len(triangles), 3), triangles]).ravel())


def read(paths: list[Path]) -> list[Solid]:
    """The solids of GLB files by node, and of STL files by the part in their name: `<design>.<part>.stl`."""
    found = []
    for path in paths:
        if path.suffix == ".glb":
            found += [Solid(node.name, node.regions) for node in meshes.read_glb(path)]
        else:
            regions = [replace(region, normals=smooth(region)) for region in meshes.read_stl(path)]
            found.append(Solid(path.name.split(".")[-2], regions))
    return found


def smooth(region: meshes.Region) -> np.ndarray:
    """Normals at the corners, the mean of the triangles round a point: STL has only theirs."""
    points, triangles = welded(region.corners)
    a, b, c = np.moveaxis(region.corners, 1, 0)
    total = np.zeros_like(points)
    for i in range(3):
        np.add.at(total, triangles[:, i], np.cross(b - a, c - a))
    return (total / np.linalg.norm(total, axis=1)[:, None])[triangles]
