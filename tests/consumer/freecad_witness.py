"""Runs inside `freecadcmd` (see witness.py): what FreeCAD makes of each STEP file.

The file must not be called like a Python module, and must not let an exception out: freecadcmd then runs it a
second time and still returns 0.
"""

import collections
import json
import os
import traceback
from pathlib import Path

import FreeCAD
import Import
import Part


def bop_faults(shape):
    """The complaints of the BOP check, the strictest judge there is, each with its number of times."""
    try:
        shape.check(True)
    except ValueError as error:
        lines = str(error).strip().splitlines()
        return dict(collections.Counter(line for line in lines if not line.startswith("BOP check found")))
    return {}


def faulty_faces(shape):
    """Where the faults sit: the centres of the faces that fail the check on their own."""
    faces = [(face, bop_faults(face)) for face in shape.Faces]
    return [{"centre": list(face.CenterOfMass), "faults": found} for face, found in faces if found]


def described(shape, label, colours, judged):
    box = shape.optimalBoundingBox()
    faults = bop_faults(shape) if judged else None
    return {
        "label": label,
        "kind": shape.ShapeType,
        "solids": len(shape.Solids),
        "valid": shape.isValid(),
        "closed": all(shell.isClosed() for shell in shape.Shells),
        "bop": faults,
        "bop_faces": faulty_faces(shape) if faults else [],
        "volume": shape.Volume,
        "box": [[box.XMin, box.YMin, box.ZMin], [box.XMax, box.YMax, box.ZMax]],
        "faces": [list(face.CenterOfMass) for face in shape.Faces],
        "colours": [list(colour[:3]) for colour in colours],
    }


def imported(path, too_great):
    """Names and colours come through the Import module: it returns (object, colours face by face).

    The BOP check takes minutes on a blade with many bores, which has it in long runs alone; the solids of an
    assembly are those of its parts, which have files of their own."""
    judged = ".assembly." not in Path(path).name and not too_great
    document = FreeCAD.newDocument("witness")
    coloured = Import.insert(path, document.Name) or []
    colours = {thing.Name: values for thing, values in coloured}
    objects = [
        described(thing.Shape, thing.Label, colours.get(thing.Name, []), judged)
        for thing in document.Objects
        if thing.isDerivedFrom("Part::Feature")
    ]
    FreeCAD.closeDocument(document.Name)
    read = Part.read(path)
    return {
        "objects": objects,
        "part": {"valid": read.isValid(), "solids": len(read.Solids), "volume": read.Volume},
    }


def main():
    # With links (the default) FreeCAD 0.20 crashes without its GUI on a file of several products.
    FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/Import").SetBool("UseLinkGroup", False)
    paths = json.loads(Path(os.environ["WITNESS_JOBS"]).read_text(encoding="utf-8"))
    with Path(os.environ["WITNESS_ANSWERS"]).open("a", encoding="utf-8") as answers:
        for path, too_great in paths:
            try:
                entry = imported(path, too_great)
            except Exception:
                entry = {"error": traceback.format_exc()}
            answers.write(json.dumps({"file": path, **entry}) + "\n")
            answers.flush()


main()
