"""Gmsh imports every STEP file, closes a mesh on it and fills it. It names volumes and colours surfaces."""

from __future__ import annotations

import pytest

import close

# Propeller blades: their tip is a point.
POINTED = ("medial-propeller", "propeller")


def files(model):
    return {part: model.file(part, "step") for part in model.parts}


def test_imports_the_solids(model, gmsh):
    for part, step in files(model).items():
        found = gmsh.of(step)
        assert found["volumes"] == len(model.solids(part)), part
        assert found["surfaces"] == model.total(part, "faces"), part
        close.assert_volume(found["mass"], model.total(part, "volume_mm3"), part)


def test_names_the_volumes(model, gmsh):
    for part, step in files(model).items():
        assert set(gmsh.of(step)["names"]) >= {f"Shapes/{solid}" for solid in model.solids(part)}


def test_keeps_the_colours_of_faces(model, gmsh):
    for part, step in files(model).items():
        found = gmsh.of(step)
        assert found["coloured"] == found["surfaces"], part


def test_meshes_the_surface_closed(model, gmsh):
    for part, step in files(model).items():
        found = gmsh.of(step)
        assert found["triangles"] > 0, part
        assert found["open_sides"] == 0, part


def test_fills_the_solids_with_tetrahedra(model, gmsh):
    for part, step in files(model).items():
        found = gmsh.of(step)["fill"]
        if "error" in found and model.name in POINTED:
            pytest.xfail(f"at the point of its tip Gmsh's own surface mesh lies on itself: {found['error']}")
        assert "error" not in found, f"{part}: {found['error']}"
        assert found["tetrahedra"] > 0, part
        assert found["inverted"] == found["unmatched"] == found["crowded"] == 0, f"{part}: {found}"
