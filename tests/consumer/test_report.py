"""What the report claims of itself; the other tests check the claims from outside."""

from __future__ import annotations

import cli
import close


def test_is_watertight(model):
    assert model.report["watertight"] is True


def test_has_the_genus_the_design_implies(model):
    assert set(model.report["genus"]) == set(model.report["solids"])
    for solid, genus in model.report["genus"].items():
        assert genus["found"] == genus["expected"], solid


def test_edges_lie_on_their_faces(model):
    assert 0 <= model.report["max_edge_deviation_mm"] <= close.TOLERANCE_MM


def test_solids_make_up_the_uncooled_blade(model):
    total = sum(solid["volume_mm3"] for solid in model.report["solids"].values())
    close.assert_volume(total, model.report["blank"]["volume_mm3"], "sum of solids", close.PARTITION)


def test_every_face_belongs_to_a_solid(model):
    for face in model.report["faces"]:
        assert face["solids"], face["name"]
        assert set(face["solids"]) <= set(model.report["solids"]), face["name"]
        assert face["area_mm2"] > 0, face["name"]


def test_face_names_are_unique(model):
    names = [face["name"] for face in model.report["faces"]]
    assert len(names) == len(set(names))


def test_areas_of_faces_add_up(model):
    for solid, values in model.report["solids"].items():
        total = sum(face["area_mm2"] for face in model.report["faces"] if solid in face["solids"])
        assert close.relative(total, values["area_mm2"]) <= 1e-6, solid


def test_every_file_is_there_and_no_other(model):
    endings = [*cli.FORMATS.values(), "centaur.csv"]
    expected = {f"{model.name}.{part}.{ending}" for part in model.parts for ending in endings}
    together = [ending for ending in endings if ending not in ("obj", "stl")]
    expected |= {f"{model.name}.assembly.{ending}" for ending in together}
    expected |= {f"{model.name}.{kind}" for kind in ("report.json", "groups.json", *cli.WHOLE.values())}
    found = {path.name for path in model.folder.iterdir()}
    assert expected <= found
    assert all(name.endswith(".mtl") for name in found - expected), found - expected
