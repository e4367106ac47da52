"""Wall thickness, measured from outside: points on a chamber's side, and how far the blade's surface is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepClass import BRepClass_FaceClassifier
from OCP.GeomAPI import GeomAPI_ProjectPointOnSurf
from OCP.gp import gp_Pnt, gp_Pnt2d
from OCP.TopAbs import TopAbs_State

from occ import NamedFace, Product

CAPS = ("blade/hub", "blade/tip")


@dataclass(frozen=True)
class Sample:
    point: np.ndarray
    distance: float
    nearest: str  # the name of the blade face


def sample(metal: Product, side: list[NamedFace], count: int = 200, margin: float = 0.12) -> list[Sample]:
    """About `count` points of these faces, the outermost `margin` of their parameters left out."""
    outer = [f for f in metal.named("blade/") if not f.name.startswith(CAPS)]
    feet = [(f.name, _Foot(f)) for f in outer]
    along = max(2, round((count / len(side)) ** 0.5))
    found = []
    for face in side:
        surface = BRepAdaptor_Surface(face.shape, True)

        u0, u1 = surface.FirstUParameter(), surface.LastUParameter()
        v0, v1 = surface.FirstVParameter(), surface.LastVParameter()
        for s in np.linspace(margin, 1 - margin, along):
            for t in np.linspace(margin, 1 - margin, along):
                u, v = u0 + s * (u1 - u0), v0 + t * (v1 - v0)
                if (
                    BRepClass_FaceClassifier(face.shape, gp_Pnt2d(u, v), 1e-9).State()
                    == TopAbs_State.TopAbs_IN
                ):
                    point = surface.Value(u, v)
                    distance, name = min((foot.distance(point), name) for name, foot in feet)
                    found.append(Sample(np.array([point.X(), point.Y(), point.Z()]), distance, name))
    return found


class _Foot:
    """Distance to one face's surface within its parameter range."""

    def __init__(self, face: NamedFace):
        adaptor = BRepAdaptor_Surface(face.shape, True)
        bounds = (adaptor.FirstUParameter(), adaptor.LastUParameter())
        bounds += (adaptor.FirstVParameter(), adaptor.LastVParameter())
        self._surface = BRep_Tool.Surface_s(face.shape)
        self._projection = GeomAPI_ProjectPointOnSurf()
        self._projection.Init(self._surface, *bounds, 1e-9)

    def distance(self, point: gp_Pnt) -> float:
        """Infinite where no normal of this face meets the point: another face is nearer then."""
        self._projection.Perform(point)
        return self._projection.LowerDistance() if self._projection.NbPoints() else np.inf
