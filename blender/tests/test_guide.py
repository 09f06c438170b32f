"""The calls that docs/guide/blender.md shows."""

import re

import bpy
import numpy as np
from support import CUBE, CUBE_FACES, PROJECT, Case, add_object, assign, key_names, select


class Guide(Case):
    def test_calls_from_scripts(self):
        page = (PROJECT / "docs/guide/blender.md").read_text(encoding="utf-8")
        (script,) = re.findall(r"^```python\n(.*?)^```", page, re.M | re.S)
        motions, deforming = script.split("\n\nmesh = ")
        calls = [line for line in motions.splitlines() if line.startswith("bpy.ops.")]
        self.assertEqual(len(calls), 4)
        twin = add_object("twin", CUBE, CUBE_FACES)
        cube = self.cube()
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "scene.blend"))
        for call in calls:
            select(*([twin] if "transfer" in call else []), cube)
            with self.subTest(call):
                self.assertEqual(eval(call), {"FINISHED"})
        deformed = add_object("deformed", CUBE, CUBE_FACES)
        for name, side in (("feet", -1), ("head", 1)):
            assign(deformed, name, np.array(CUBE)[:, 2] * side > 0)
        exec("mesh = " + deforming, {"bpy": bpy})
        self.assertEqual(key_names(deformed), ["Basis", "deformed", "repaired"])
