"""Runs in a process of its own (see witness.py): imports each STEP file into Gmsh and meshes its surface."""

import json
import os
import traceback
from pathlib import Path

import gmsh
import numpy as np


def meshed(path: str) -> dict:
    gmsh.clear()
    gmsh.model.occ.importShapes(path)
    gmsh.model.occ.synchronize()
    volumes = gmsh.model.getEntities(3)
    low, high = np.reshape(gmsh.model.getBoundingBox(-1, -1), (2, 3))
    size = float(np.linalg.norm(high - low)) / 25
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.option.setNumber("Mesh.MeshSizeMin", size / 8)
    gmsh.model.mesh.generate(2)
    triangles = np.concatenate(
        [gmsh.model.mesh.getElementsByType(2, tag)[1].reshape(-1, 3) for _, tag in gmsh.model.getEntities(2)]
    ).astype(np.int64)
    sides = np.sort(
        np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1
    )
    _, times = np.unique(sides, axis=0, return_counts=True)
    gmsh.model.mesh.generate(3)
    names = (gmsh.model.getEntityName(dimension, tag) for dimension, tag in gmsh.model.getEntities())
    return {
        "volumes": len(volumes),
        "mass": sum(gmsh.model.occ.getMass(3, tag) for _, tag in volumes),
        "surfaces": len(gmsh.model.getEntities(2)),
        "box": [low.tolist(), high.tolist()],
        "triangles": len(triangles),
        "open_sides": int((times != 2).sum()),
        "filled": [filled(tag) for _, tag in volumes],
        "coloured": sum(gmsh.model.getColor(2, tag)[3] == 255 for _, tag in gmsh.model.getEntities(2)),
        "names": sorted({name for name in names if name}),
    }


def filled(tag: int) -> float:
    """Volume of the tetrahedra in a volume over that inside its triangles: 1 if they fill it."""
    numbers, coordinates, _ = gmsh.model.mesh.getNodes()
    place = np.zeros((int(numbers.max()) + 1, 3))
    place[numbers.astype(np.int64)] = coordinates.reshape(-1, 3)
    corners = place[gmsh.model.mesh.getElementsByType(4, tag)[1].reshape(-1, 4).astype(np.int64)]
    inside = 0.0
    for _, signed in gmsh.model.getBoundary([(3, tag)], oriented=True):
        nodes = gmsh.model.mesh.getElementsByType(2, abs(signed))[1].reshape(-1, 3).astype(np.int64)
        a, b, c = np.moveaxis(place[nodes] - place[1:].mean(0), 1, 0)
        inside += np.sign(signed) * np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    edges = corners[:, 1:] - corners[:, :1]
    return float(np.abs(np.linalg.det(edges)).sum() / 6 / abs(inside)) if len(edges) else 0.0


def main() -> None:
    paths = json.loads(Path(os.environ["WITNESS_JOBS"]).read_text(encoding="utf-8"))
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Verbosity", 1)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 8)
    with Path(os.environ["WITNESS_ANSWERS"]).open("a", encoding="utf-8") as answers:
        for path, _ in paths:
            try:
                entry = meshed(path)
            except Exception:
                entry = {"error": traceback.format_exc()}
            answers.write(json.dumps({"file": path, **entry}) + "\n")
            answers.flush()
    gmsh.finalize()


main()
