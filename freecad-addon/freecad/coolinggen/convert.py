"""From the sidecar's files to shapes of FreeCAD whose faces have names and colours.

The files are BREP, shapes as FreeCAD has them. The triangles for the view still take seconds; in FreeCAD's
window they are made by a FreeCAD without one, which hands the shapes over with them.
"""

import contextlib
import json
import math
import os
import shutil
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import FreeCAD as App
import Part

from .client.latest import Watch
from .client.mesh import Mesh, decode
from .client.sidecar import SidecarError

#: A vertex of a face and that of its mesh are the same point but for the mesh's single precision, mm over mm.
NEAR = 1e-6
#: FreeCAD's default deviation of the view from the shape, over a third of its size, and its angle.
DEVIATION, ANGLE_DEG = 0.005, 28.5


@dataclass(frozen=True)
class Solid:
    """A solid as it goes into a document."""

    name: str
    shape: Part.Shape
    faces: list[str]
    colors: list[tuple[float, float, float]]


def read(brep: Path, meshes: list[Mesh]) -> list[Solid]:
    """The solids of a BREP file, which are in the order of their meshes."""
    shapes = Part.read(str(brep)).Solids
    if len(shapes) != len(meshes):
        raise SidecarError(f"{brep.name} came in with {len(shapes)} solids, not {len(meshes)}")
    return [_named(shape, mesh) for shape, mesh in zip(shapes, meshes, strict=True)]


def _named(shape: Part.Shape, mesh: Mesh) -> Solid:
    """Faces are in the order of the mesh's, which every vertex has to confirm."""
    faces = shape.Faces
    if len(faces) != len(mesh.faces):
        raise SidecarError(f"{mesh.name} came in with {len(faces)} faces, not {len(mesh.faces)}")
    for face, known in zip(faces, mesh.faces, strict=True):
        points = mesh.points(known)
        for vertex in face.Vertexes:
            p = vertex.Point
            off = min(max(abs(p.x - x), abs(p.y - y), abs(p.z - z)) for x, y, z in points)
            if off > 1e-4 + NEAR * p.Length:
                raise SidecarError(f"{known.name} of {mesh.name} came in {off:.3g} mm off its place")
    return Solid(mesh.name, shape, [f.name for f in mesh.faces], [f.color for f in mesh.faces])


def read_beside(brep: Path, reply: dict, watch: Watch) -> list[Solid]:
    """As ``read``, in another process; ``reply`` is that of ``model/tessellate``.

    Without FreeCAD's command it is done here.
    """
    command = _freecad_command()
    meshes = [decode(solid) for solid in reply["solids"]]
    if command is None:
        return read(brep, meshes)
    folder = brep.parent
    (folder / "meshes.json").write_text(json.dumps(reply), encoding="utf-8")
    package = Path(__file__).parents[1]
    script = folder / "coolinggen_reads.py"
    script.write_text(
        "import freecad\n"
        f"freecad.__path__.append({str(package)!r})\n"
        "from freecad.coolinggen.convert import serve\n"
        f"serve({str(folder)!r}, {brep.name!r})\n",
        encoding="utf-8",
    )
    _run([command, str(script)], folder, watch)
    told = folder / "told.txt"
    if not told.is_file():
        raise SidecarError("FreeCAD did not read what coolinggen wrote")
    if text := told.read_text(encoding="utf-8"):
        raise SidecarError(text)
    solids = []
    for k, mesh in enumerate(meshes):
        shape = Part.Shape()
        shape.importBrep(str(folder / f"{k}.brep"))
        solids.append(Solid(mesh.name, shape, [f.name for f in mesh.faces], [f.color for f in mesh.faces]))
    return solids


def serve(folder: str, brep: str) -> None:
    """What the other process does; it ends here."""
    place = Path(folder)
    try:
        meshes = json.loads((place / "meshes.json").read_text(encoding="utf-8"))["solids"]
        for k, solid in enumerate(read(place / brep, [decode(mesh) for mesh in meshes])):
            _triangles(solid.shape)
            solid.shape.exportBrep(str(place / f"{k}.brep"))
        told = ""
    except Exception as error:  # told to the process that waits
        told = str(error) or type(error).__name__
    (place / "told.txt").write_text(told, encoding="utf-8")
    # No farewell: the user's settings are none of this process's business.
    os._exit(0)


def _triangles(shape: Part.Shape) -> None:
    """Gives a shape the triangles that its view will ask for."""
    with contextlib.suppress(ImportError):
        import MeshPart

        box = shape.BoundBox
        deviation = (box.XLength + box.YLength + box.ZLength) / 3 * DEVIATION
        MeshPart.meshFromShape(
            Shape=shape, LinearDeflection=deviation, AngularDeflection=math.radians(ANGLE_DEG)
        )


def _freecad_command() -> str | None:
    """FreeCAD without a window, of this installation if it can be found."""
    names = ("freecadcmd", "FreeCADCmd", "FreeCADCmd.exe", "freecadcmd.exe")
    for folder in (Path(App.getHomePath()) / "bin", Path(App.getHomePath()).parent / "bin"):
        for name in names:
            if (folder / name).is_file():
                return str(folder / name)
    return next((found for name in names[:2] if (found := shutil.which(name))), None)


def _run(command: list[str], folder: Path, watch: Watch) -> None:
    hidden = {"creationflags": subprocess.CREATE_NO_WINDOW} if os.name == "nt" else {}
    # A home of its own: neither the user's settings nor other add-ons are read or written.
    with tempfile.TemporaryDirectory(prefix="coolinggen-home-") as home:
        process = subprocess.Popen(
            command,
            cwd=folder,
            env={**os.environ, "FREECAD_USER_HOME": home},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            **hidden,
        )
        try:
            while process.poll() is None:
                watch.check()
                time.sleep(0.02)
        finally:
            if process.poll() is None:
                process.kill()
                process.wait()
