#!/usr/bin/env python3
"""Meshes @NAME@ with Gmsh: every solid filled with tetrahedra, neighbours sharing their nodes.

    python3 @NAME@.gmsh.py [--out FILE] [--cells N] [--largest MM] [--surface]

needs Gmsh's Python module (`pip install gmsh`) and, beside this script, @SHAPE@ and @MANIFEST@. Surfaces are told by
where they are, not by their numbers; each group of the manifest becomes a physical group, each solid another.
"""

import argparse
import bisect
import json
import math
from pathlib import Path

import gmsh

HERE = Path(__file__).resolve().parent
MANIFEST = HERE / "@MANIFEST@"
SHAPE = HERE / "@SHAPE@"

#: Shares by which Gmsh's area of a face, and its centre over the root of the area, may differ from the manifest's.
AREA_SHARE, CENTRE_SHARE = 0.03, 0.03


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--out", type=Path, default=HERE / "@NAME@.msh", help="file for the mesh")
    arguments.add_argument("--cells", type=float, default=1, help="cells across a hole, slot or wall")
    arguments.add_argument("--largest", type=float, help="largest cell, mm; a 25th of the blade if not given")
    arguments.add_argument("--surface", action="store_true", help="triangles only")
    options = arguments.parse_args()
    manifest = json.loads(MANIFEST.read_text(encoding="utf-8"))

    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.model.add("@NAME@")
    gmsh.model.occ.importShapes(str(SHAPE))
    gmsh.model.occ.synchronize()

    names = named_surfaces(manifest["faces"])
    add_groups(manifest, names)
    set_sizes(manifest, names, options.cells, options.largest)
    gmsh.model.mesh.generate(2 if options.surface else 3)
    gmsh.write(str(options.out))
    print(f"{options.out}: {len(gmsh.model.mesh.getNodes()[0])} nodes, {len(names)} surfaces")
    gmsh.finalize()


def named_surfaces(faces: list[dict]) -> dict[int, str]:
    """The manifest's name of each of Gmsh's surfaces: that of the face with its area and its centre."""
    faces = sorted(faces, key=lambda face: face["area_mm2"])
    areas = [face["area_mm2"] for face in faces]
    names = {}
    for _, tag in gmsh.model.getEntities(2):
        area, centre = gmsh.model.occ.getMass(2, tag), gmsh.model.occ.getCenterOfMass(2, tag)
        low = bisect.bisect_left(areas, area * (1 - AREA_SHARE))
        high = bisect.bisect_right(areas, area * (1 + AREA_SHARE))
        ranked = sorted((math.dist(centre, face["centroid_mm"]), face["name"]) for face in faces[low:high])
        if not ranked or ranked[0][0] > CENTRE_SHARE * math.sqrt(area):
            raise SystemExit(f"surface {tag}, {area:.4g} mm2 at {centre}, is no face of {MANIFEST.name}")
        names[tag] = ranked[0][1]
    missing = {face["name"] for face in faces} - set(names.values())
    if missing or len(set(names.values())) < len(names):
        raise SystemExit(f"faces that no surface, or more than one, is: {sorted(missing)}")
    return names


def add_groups(manifest: dict, names: dict[int, str]) -> None:
    """A physical surface a group, a physical volume a solid."""
    group_of = {face["name"]: face["group"] for face in manifest["faces"]}
    for group in manifest["groups"]:
        tags = [tag for tag, name in names.items() if group_of[name] == group["name"]]
        gmsh.model.addPhysicalGroup(2, tags, name=group["name"])
    faces_of = {solid["name"]: set(solid["faces"]) for solid in manifest["solids"]}
    for _, volume in gmsh.model.getEntities(3):
        border = {names[tag] for tag in gmsh.model.getAdjacencies(3, volume)[1]}
        solid = next(name for name, faces in faces_of.items() if faces == border)
        gmsh.model.addPhysicalGroup(3, [volume], name=solid)


def set_sizes(manifest: dict, names: dict[int, str], cells: float, largest: float | None) -> None:
    """Small cells along small things: at the corners of faces, growing from there."""
    box = gmsh.model.getBoundingBox(-1, -1)
    largest = largest or math.dist(box[:3], box[3:]) / 25
    features = {face["name"]: face.get("feature_mm") for face in manifest["faces"]}
    sizes: dict[int, float] = {}
    for tag, name in names.items():
        if feature := features[name]:
            for _, point in gmsh.model.getBoundary([(2, tag)], recursive=True):
                sizes[point] = min(feature / cells, sizes.get(point, largest))
    for point, size in sizes.items():
        gmsh.model.mesh.setSize([(0, point)], size)
    gmsh.option.setNumber("Mesh.MeshSizeMax", largest)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 6)


main()
