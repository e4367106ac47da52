"""FreeCAD opens every STEP file. Names come as object labels and colours face by face, without its GUI too;
names of faces it does not keep (test_occ.py has them)."""

from __future__ import annotations

import numpy as np

import close
import witness


def files(model):
    return {part: model.file(part, "step") for part in model.parts}


def test_valid(model, freecad):
    for part, step in files(model).items():
        found = freecad.of(step)
        assert found["part"]["valid"], part
        for thing in found["objects"]:
            assert thing["valid"] and thing["closed"] and thing["solids"] == 1, thing["label"]


def test_bop_check_is_clean(model, freecad):
    left = []
    for part, step in files(model).items():
        for thing in freecad.of(step)["objects"]:
            if thing["bop"] is None:
                left.append(thing["label"])
            assert not thing["bop"], f"{thing['label']}: {thing['bop']}\n" + "\n".join(
                f"  {nearest_face(model, part, face['centre'])}: {face['faults']}"
                for face in thing["bop_faces"]
            )
    if left:
        witness.leave_to_long(", ".join(left))


def nearest_face(model, part: str, centre: list[float]) -> str:
    def distance(face: dict) -> float:
        return float(np.linalg.norm(np.subtract(face["centroid_mm"], centre)))

    return min(model.faces(part), key=distance)["name"]


def test_volume(model, freecad):
    for part, step in files(model).items():
        found, expected = freecad.of(step), model.total(part, "volume_mm3")
        close.assert_volume(sum(thing["volume"] for thing in found["objects"]), expected, f"{part} by Import")
        close.assert_volume(found["part"]["volume"], expected, f"{part} by Part")


def test_bounding_box_in_mm(model, freecad):
    for part, step in files(model).items():
        boxes = np.array([thing["box"] for thing in freecad.of(step)["objects"]])
        close.assert_held([boxes[:, 0].min(0), boxes[:, 1].max(0)], model.box(part), part)


def test_names(model, freecad):
    for part, step in files(model).items():
        assert sorted(thing["label"] for thing in freecad.of(step)["objects"]) == sorted(model.solids(part))
    assembly = freecad.of(model.file("assembly", "step"))
    assert sorted(thing["label"] for thing in assembly["objects"]) == sorted(model.report["solids"])


def test_colours_of_faces(model, library, freecad):
    """The same as in the file: FreeCAD gives sRGB, OpenCASCADE's document linear light."""
    for step in files(model).values():
        for thing in freecad.of(step)["objects"]:
            product = next(p for p in library.products(step) if p.name == thing["label"])
            expected = np.array(sorted(srgb(face.colour) for face in product.faces if face.colour))
            assert len(thing["colours"]) == len(expected) == len(product.faces), thing["label"]
            assert np.abs(np.array(sorted(thing["colours"])) - expected).max() < close.COLOUR, thing["label"]


def srgb(linear) -> list[float]:
    return [12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055 for c in linear]
