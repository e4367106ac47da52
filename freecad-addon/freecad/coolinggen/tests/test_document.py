"""A blade in a document, without a window: ``freecadcmd -t freecad.coolinggen.tests.test_document``."""

import contextlib
import json
import tempfile
import unittest
from pathlib import Path

import FreeCAD as App
import Part
from freecad.coolinggen import blade, faces, service, source
from freecad.coolinggen.client.sidecar import CancelledError, MissingError, RefusedError, Sidecar, find


def template(name: str = "rotor") -> dict:
    return service.sidecar().call("template/get", name=name)["design"]


class BladeInDocument(unittest.TestCase):
    def setUp(self):
        self.document = App.newDocument("Test")

    def tearDown(self):
        for name in list(App.listDocuments()):
            App.closeDocument(name)

    def test_the_shape_is_what_the_report_says_in_inches_too(self):
        before = App.Units.getSchema()
        App.Units.setSchema(3)
        try:
            made = blade.new(self.document, template())
        finally:
            App.Units.setSchema(before)
        report = json.loads(made.Report)
        self.assertEqual(sorted(solid.SolidName for solid in made.Solids), sorted(report["solids"]))
        self.assertEqual(made.Solids[0].SolidName, "metal")
        for solid in made.Solids:
            shape, known = solid.Shape, report["solids"][solid.SolidName]
            self.assertTrue(shape.isValid())
            self.assertEqual(shape.ShapeType, "Solid")
            shape.check(True)  # raises where the BOP check finds something
            self.assertAlmostEqual(shape.Volume / known["volume_mm3"], 1, delta=2e-5)
            self.assertEqual(len(solid.FaceNames), len(shape.Faces))
            self.assertEqual(len(solid.FaceColors), len(shape.Faces))
            named = {face["name"]: face for face in report["faces"] if solid.SolidName in face["solids"]}
            self.assertEqual(set(solid.FaceNames), set(named))
            for name, face in zip(solid.FaceNames, shape.Faces, strict=True):
                away = face.CenterOfMass - App.Vector(*named[name]["centroid_mm"])
                self.assertLess(away.Length, 1e-3 * named[name]["area_mm2"] ** 0.5, name)

    def test_groups_for_boundary_conditions_are_those_of_the_files(self):
        design = template()
        design["groups"] = [{"faces": "blade/*_side", "name": "airfoil"}]
        made = blade.new(self.document, design)
        group = faces.groups(made)
        with tempfile.TemporaryDirectory() as folder:
            model = blade.request(made).model
            server = service.sidecar()
            server.call("design/generate", model=model, design=design, report=False)
            server.call("model/export", model=model, folder=folder, formats=["nastran"], solids=["metal"])
            (manifest,) = Path(folder).glob("*.groups.json")
            known = json.loads(manifest.read_text(encoding="utf-8"))["faces"]
        expected = {(f"{solid}: {face['group']}", face["name"]) for face in known for solid in face["solids"]}
        found = set()
        for member in group.Group:
            child, names = member.References
            found |= {(member.Label, faces.name_of(child, name)) for name in names}
        self.assertEqual(found, expected)
        self.assertIn("metal: airfoil", {member.Label for member in group.Group})
        self.assertIn("airfoil", faces.regions(made))

    def test_a_changed_design_keeps_names_and_place(self):
        made = blade.new(self.document, template())
        made.Placement.Base = App.Vector(0, 0, 100)
        metal = made.Solids[0]
        names, volume, colors = list(metal.FaceNames), metal.Shape.Volume, list(metal.FaceColors)
        design = json.loads(made.Design)
        design["cooling"]["shell"]["suction_side"] = 1.0
        made.Design = json.dumps(design)
        self.document.recompute()
        self.assertIs(made.Solids[0], metal)
        self.assertEqual(list(metal.FaceNames), names)
        self.assertEqual(list(metal.FaceColors), colors)
        self.assertLess(metal.Shape.Volume, volume)
        self.assertEqual(metal.Placement.Base.z, 100)
        # What is made of a solid follows it.
        self.assertFalse(any("Touched" in obj.State for obj in self.document.Objects))

    def test_a_copy_has_solids_of_its_own(self):
        made = blade.new(self.document, template())
        volume = made.Solids[0].Shape.Volume
        for deep in (True, False):
            copy = self.document.copyObject(made, deep)
            design = json.loads(copy.Design)
            design["cooling"]["shell"]["suction_side"] = 1.0
            copy.Design = json.dumps(design)
            self.document.recompute()
            self.assertLess(copy.Solids[0].Shape.Volume, volume)
            self.assertAlmostEqual(made.Solids[0].Shape.Volume, volume, places=9)

    def test_undo_takes_solids_and_design_back_without_building(self):
        self.document.UndoMode = 1
        made = blade.new(self.document, template())
        design, volume = made.Design, made.Solids[0].Shape.Volume
        self.document.openTransaction("Thinner")
        thinner = json.loads(design)
        thinner["cooling"]["shell"]["suction_side"] = 1.0
        made.Design = json.dumps(thinner)
        self.document.recompute()
        self.document.commitTransaction()
        self.assertLess(made.Solids[0].Shape.Volume, volume)
        service.stop()
        self.document.undo()
        self.document.recompute()
        self.assertEqual(made.Design, design)
        self.assertAlmostEqual(made.Solids[0].Shape.Volume, volume, places=9)
        self.assertIsNone(service._sidecar)
        self.document.redo()
        self.assertLess(made.Solids[0].Shape.Volume, volume)

    def test_a_refused_design_keeps_the_shape_and_says_why(self):
        made = blade.new(self.document, template())
        faces = len(made.Solids[0].Shape.Faces)
        design = json.loads(made.Design)
        design["cooling"]["shell"]["suction_side"] = -1
        made.Design = json.dumps(design)
        self.document.recompute()
        self.assertFalse(made.isValid())
        self.assertEqual(len(made.Solids[0].Shape.Faces), faces)
        self.assertIn("/cooling/shell/suction_side", made.Refusal[0])
        design["cooling"]["shell"]["suction_side"] = 1.2
        made.Design = json.dumps(design)
        self.document.recompute()
        self.assertTrue(made.isValid())
        self.assertEqual(list(made.Refusal), [])

    def test_save_and_reopen_keep_the_blade_and_its_life(self):
        made = blade.new(self.document, template())
        volume, names = made.Solids[0].Shape.Volume, list(made.Solids[0].FaceNames)
        with tempfile.TemporaryDirectory() as folder:
            path = str(Path(folder) / "blade \u00e4.FCStd")
            self.document.saveAs(path)
            App.closeDocument(self.document.Name)
            reopened = App.openDocument(path)
            made = reopened.getObject("CooledBlade")
            metal = made.Solids[0]
            self.assertAlmostEqual(metal.Shape.Volume, volume, places=6)
            self.assertEqual(list(metal.FaceNames), names)
            design = json.loads(made.Design)
            design["cooling"]["shell"]["suction_side"] = 1.0
            made.Design = json.dumps(design)
            reopened.recompute()
            self.assertLess(metal.Shape.Volume, volume)

    def test_a_killed_sidecar_is_started_again(self):
        made = blade.new(self.document, template())
        process = service.sidecar()._process
        process.kill()
        process.wait()
        blade.rebuild(made)
        self.assertTrue(made.isValid())


def _distance(surface, point) -> float:
    return (surface.value(*surface.parameter(point)) - point).Length


class Taken(unittest.TestCase):
    """Blades that were drawn before."""

    @classmethod
    def setUpClass(cls):
        design = template()
        del design["cooling"]
        cls.plain = blade.new(App.newDocument("Plain"), design).Solids[0].Shape.copy()

    def tearDown(self):
        for name in list(App.listDocuments()):
            App.closeDocument(name)

    def cooled(self, faces, placement):
        chosen = source.of_shape(faces, placement, "Drawn blade")
        document = App.newDocument("Taken")
        made = blade.new(document, chosen.design, file=chosen.file, placement=chosen.placement)
        self.assertEqual(list(made.Refusal), [])
        return made

    def lies_on(self, made, drawn):
        """Borders of the cooled blade's sides lie on the faces that were drawn."""
        metal = made.Solids[0]
        sides = [
            f
            for n, f in zip(metal.FaceNames, metal.Shape.Faces, strict=True)
            if "_side" in n and "blade/" in n
        ]
        self.assertGreaterEqual(len(sides), 2)
        surfaces = [face.Surface for face in drawn if isinstance(face.Surface, Part.BSplineSurface)]
        for edge in (edge for side in sides for edge in side.Edges):
            point = edge.valueAt((edge.FirstParameter + edge.LastParameter) / 2)
            self.assertLess(min(_distance(surface, point) for surface in surfaces), 2e-3)

    def test_a_solid_of_several_faces_is_cooled_in_its_place(self):
        placement = App.Placement(App.Vector(7, -400, 30), App.Rotation(App.Vector(1, 2, 3), 70))
        made = self.cooled(list(self.plain.Faces), placement)
        drawn = self.plain.copy()
        drawn.Placement = placement
        self.assertEqual(json.loads(made.Design)["blade"]["kind"], "step")
        self.assertTrue(made.Solids[0].Shape.isValid())
        self.lies_on(made, drawn.Faces)

    def test_a_file_that_a_blade_was_made_of_goes_with_its_document(self):
        made = self.cooled(list(self.plain.Faces), App.Placement())
        volume = made.Solids[0].Shape.Volume
        with tempfile.TemporaryDirectory() as folder:
            path = str(Path(folder) / "taken.FCStd")
            made.Document.saveAs(path)
            App.closeDocument(made.Document.Name)
            made = App.openDocument(path).getObject("CooledBlade")
            blade.rebuild(made)
            self.assertTrue(made.isValid(), list(made.Refusal))
            self.assertAlmostEqual(made.Solids[0].Shape.Volume / volume, 1, places=9)


class Client(unittest.TestCase):
    def test_a_missing_sidecar_is_told(self):
        with self.assertRaises(MissingError):
            find("/nowhere/coolinggen")
        with self.assertRaises(MissingError):
            Sidecar("/bin/cat", "test")
        with self.assertRaises(MissingError):
            Sidecar("/bin/true", "test")

    def test_faults_come_all_at_once(self):
        design = template()
        design["cooling"]["shell"]["suction_side"] = -1
        design["nonsense"] = 1
        with self.assertRaises(RefusedError) as caught:
            service.sidecar().call("design/generate", design=design)
        pointers = {fault["pointer"] for fault in caught.exception.faults}
        self.assertEqual(pointers, {"/design/cooling/shell/suction_side", "/design/nonsense"})

    def test_progress_is_told_and_cancelling_heard(self):
        told = []
        design = template("rotor-serpentine")
        service.sidecar().call("design/generate", design=design, progress=lambda *p: told.append(p))
        self.assertTrue(told and told[0] == ("blade", 0.0))
        design["space"]["hub"][0][1] += 1e-3
        # Or it is done in time.
        with contextlib.suppress(CancelledError):
            service.sidecar().call("design/generate", design=design, cancelled=lambda: True)


if __name__ == "__main__":
    unittest.main()
