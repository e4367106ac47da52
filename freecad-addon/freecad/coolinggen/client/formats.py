"""Formats of files that the sidecar writes, and what they are for."""

#: Title and purpose of each, by the sidecar's name.
FORMATS = {
    "step": ("STEP", "Exact solids for CAD"),
    "step_ap242": ("STEP AP242", "Exact solids, faces named by shape aspects, too"),
    "brep": ("BREP", "Exact solids for programs with Open CASCADE, quick to read"),
    "iges": ("IGES solids", "Solids with named panels for CENTAUR"),
    "iges_surfaces": ("IGES surfaces", "Trimmed surfaces for readers without solids"),
    "glb": ("glTF", "Meshes with materials"),
    "obj": ("OBJ", "Meshes with groups"),
    "stl": ("STL", "Meshes with named regions"),
    "nastran": ("Nastran", "Meshes with named properties"),
    "gmsh": ("Gmsh", "A script that fills all solids with one mesh"),
    "openfoam": ("OpenFOAM", "A case for snappyHexMesh"),
}
