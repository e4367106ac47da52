"""A blade in a document, without a window: ``freecadcmd -t freecad.coolinggen.tests.test_document``."""

import contextlib
import json
import tempfile
import unittest
from pathlib import Path

import FreeCAD as App
from freecad.coolinggen import blade, service
from freecad.coolinggen.client.sidecar import CancelledError, MissingError, RefusedError, Sidecar, find


def template(name: str = "rotor") -> dict:
    return service.sidecar().call("template/get", name=name)["design"]


class BladeInDocument(unittest.TestCase):
    def setUp(self):
        self.document = App.newDocument("Test")

    def tearDown(self):
        for name in list(App.listDocuments()):
            App.closeDocument(name)

    def test_the_shape_is_what_the_report_says(self):
        made = blade.new(self.document, template())
        report = json.loads(made.Report)
        self.assertTrue(made.Shape.isValid())
        self.assertEqual(sorted(made.SolidNames), sorted(report["solids"]))
        for solid, name in zip(made.Shape.Solids, made.SolidNames, strict=True):
            self.assertAlmostEqual(solid.Volume / report["solids"][name]["volume_mm3"], 1, delta=2e-5)
        self.assertEqual(len(made.FaceNames), len(made.Shape.Faces))
        self.assertEqual(set(made.FaceNames), {face["name"] for face in report["faces"]})

    def test_a_changed_design_keeps_names_and_place(self):
        made = blade.new(self.document, template())
        made.Placement.Base = App.Vector(0, 0, 100)
        names, volume = list(made.FaceNames), made.Shape.Solids[0].Volume
        design = json.loads(made.Design)
        design["cooling"]["shell"]["suction_side"] = 1.0
        made.Design = json.dumps(design)
        self.document.recompute()
        self.assertEqual(list(made.FaceNames), names)
        self.assertLess(made.Shape.Solids[0].Volume, volume)
        self.assertEqual(made.Placement.Base.z, 100)

    def test_a_refused_design_keeps_the_shape_and_says_why(self):
        made = blade.new(self.document, template())
        faces = len(made.Shape.Faces)
        design = json.loads(made.Design)
        design["cooling"]["shell"]["suction_side"] = -1
        made.Design = json.dumps(design)
        self.document.recompute()
        self.assertFalse(made.isValid())
        self.assertEqual(len(made.Shape.Faces), faces)
        self.assertIn("/design/cooling/shell/suction_side", made.Refusal[0])
        design["cooling"]["shell"]["suction_side"] = 1.2
        made.Design = json.dumps(design)
        self.document.recompute()
        self.assertTrue(made.isValid())
        self.assertEqual(list(made.Refusal), [])

    def test_save_and_reopen_keep_the_blade_and_its_life(self):
        made = blade.new(self.document, template())
        volume, names = made.Shape.Solids[0].Volume, list(made.FaceNames)
        with tempfile.TemporaryDirectory() as folder:
            path = str(Path(folder) / "blade \u00e4.FCStd")
            self.document.saveAs(path)
            App.closeDocument(self.document.Name)
            reopened = App.openDocument(path)
            made = reopened.getObject("CooledBlade")
            self.assertAlmostEqual(made.Shape.Solids[0].Volume, volume, places=6)
            self.assertEqual(list(made.FaceNames), names)
            design = json.loads(made.Design)
            design["cooling"]["shell"]["suction_side"] = 1.0
            made.Design = json.dumps(design)
            reopened.recompute()
            self.assertLess(made.Shape.Solids[0].Volume, volume)

    def test_a_killed_sidecar_is_started_again(self):
        made = blade.new(self.document, template())
        process = service.sidecar()._process
        process.kill()
        process.wait()
        made.touch()
        self.document.recompute()
        self.assertTrue(made.isValid())


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
