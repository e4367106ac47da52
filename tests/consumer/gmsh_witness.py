"""Runs in a process of its own (see witness.py): imports each STEP file into Gmsh and meshes it."""

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
    names = (gmsh.model.getEntityName(dimension, tag) for dimension, tag in gmsh.model.getEntities())
    return {
        "volumes": len(volumes),
        "mass": sum(gmsh.model.occ.getMass(3, tag) for _, tag in volumes),
        "surfaces": len(gmsh.model.getEntities(2)),
        "box": [low.tolist(), high.tolist()],
        "triangles": len(triangles),
        "open_sides": int((times != 2).sum()),
        "fill": fill(),
        "coloured": sum(gmsh.model.getColor(2, tag)[3] == 255 for _, tag in gmsh.model.getEntities(2)),
        "names": sorted({name for name in names if name}),
    }


def fill() -> dict:
    """Fills the volumes with tetrahedra: how many; how many of these are flat or inside out; how many of the
    outer faces are no triangle of the surface's mesh, or the other way round; and faces of more than two."""
    try:
        gmsh.model.mesh.generate(3)
    except Exception as error:
        return {"error": str(error)}
    numbers, coordinates, _ = gmsh.model.mesh.getNodes()
    place = np.zeros((int(numbers.max()) + 1, 3))
    place[numbers.astype(np.int64)] = coordinates.reshape(-1, 3)
    corners = gmsh.model.mesh.getElementsByType(4)[1].reshape(-1, 4).astype(np.int64)
    edges = place[corners[:, 1:]] - place[corners[:, :1]]
    faces = np.concatenate([np.delete(corners, k, axis=1) for k in range(4)])
    unique, times = np.unique(np.sort(faces, axis=1), axis=0, return_counts=True)
    surface = gmsh.model.mesh.getElementsByType(2)[1].reshape(-1, 3).astype(np.int64)
    border = {tuple(face) for face in unique[times == 1].tolist()}
    return {
        "tetrahedra": len(corners),
        "inverted": int((np.linalg.det(edges) <= 0).sum()),
        "unmatched": len(border ^ {tuple(face) for face in np.sort(surface, axis=1).tolist()}),
        "crowded": int((times > 2).sum()),
    }


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
