"""The add-on as a whole: registration, and what Blender wants to know of it."""

import re
import tomllib
import unittest

import bpy
import shapespace_addon
from support import ADDON, PROJECT

FOLDER = PROJECT / "blender" / ADDON


class Addon(unittest.TestCase):
    def test_is_gone_after_it_is_disabled_and_there_again(self):
        operators = {
            "inbetweens", "extrapolate", "transfer", "deform", "deform_live", "repair", "marker_add"
        }  # fmt: skip
        for _ in range(2):
            self.assertLessEqual(operators, set(dir(bpy.ops.shapespace)))
            self.assertTrue(hasattr(bpy.context.scene, "shapespace"))
            self.assertTrue(hasattr(bpy.types, "SHAPESPACE_PT_panel"))
            self.assertTrue(hasattr(bpy.types.Object, "shapespace_handles"))
            self.assertEqual([len(menu) for menu in self.menus()], [1, 1, 1])
            bpy.ops.preferences.addon_disable(module=ADDON)
            self.assertEqual(set(dir(bpy.ops.shapespace)) & operators, set())
            self.assertFalse(hasattr(bpy.context.scene, "shapespace"))
            self.assertFalse(hasattr(bpy.types, "SHAPESPACE_PT_panel"))
            self.assertFalse(hasattr(bpy.types.Object, "shapespace_handles"))
            self.assertEqual([len(menu) for menu in self.menus()], [0, 0, 0])
            bpy.ops.preferences.addon_enable(module=ADDON)

    def menus(self):
        """What the add-on has appended to each of Blender's menus that it appends to."""
        return [
            [draw for draw in menu.draw._draw_funcs if "shapespace" in draw.__module__]
            for menu in (
                bpy.types.MESH_MT_shape_key_context_menu,
                bpy.types.VIEW3D_MT_object,
                bpy.types.VIEW3D_MT_edit_mesh_vertices,
            )
        ]

    def test_nothing_is_computed_where_settings_are_changed_afterwards(self):
        """There Blender stands still, and only operators with REGISTER are there."""
        for name in ("inbetweens", "extrapolate", "transfer", "average", "deform", "repair"):
            kind = getattr(bpy.types, f"SHAPESPACE_OT_{name}")
            self.assertEqual(kind.bl_options, {"UNDO"})


class Manifest(unittest.TestCase):
    """docs.blender.org/manual/en/latest/advanced/extensions/getting_started.html"""

    def setUp(self):
        self.manifest = tomllib.loads((FOLDER / "blender_manifest.toml").read_text())

    def test_has_what_blender_4_2_requires(self):
        manifest = self.manifest
        self.assertEqual(manifest["schema_version"], "1.0.0")
        self.assertEqual(manifest["type"], "add-on")
        self.assertTrue(manifest["id"].isidentifier() and "__" not in manifest["id"])
        for key in ("version", "blender_version_min"):
            self.assertRegex(manifest[key], r"^\d+\.\d+\.\d+$")
        self.assertGreaterEqual(
            [int(part) for part in manifest["blender_version_min"].split(".")], [4, 2, 0]
        )
        for key in ("name", "maintainer"):
            self.assertTrue(manifest[key].strip())
        self.assertEqual(manifest["license"], ["SPDX:BSD-3-Clause"])
        self.assertLessEqual(set(manifest["tags"]), {"Animation", "Mesh", "Modeling", "Rigging"})

    def test_lines_for_people_are_short_and_without_a_full_stop(self):
        lines = [self.manifest["tagline"], *self.manifest["permissions"].values()]
        for line in lines:
            self.assertLessEqual(len(line), 64)
            self.assertTrue(line[-1].isalnum())
        self.assertLessEqual(
            set(self.manifest["permissions"]),
            {"files", "network", "clipboard", "camera", "microphone"},
        )

    def test_says_the_same_as_bl_info_and_the_library(self):
        info = shapespace_addon.bl_info
        self.assertEqual(self.manifest["version"], ".".join(map(str, info["version"])))
        self.assertEqual(self.manifest["name"], info["name"])
        self.assertEqual(self.manifest["tagline"], info["description"])
        cmake = (PROJECT / "CMakeLists.txt").read_text()
        version = re.search(r"project\(ShapeSpace VERSION ([\d.]+)", cmake)[1]
        self.assertEqual(self.manifest["version"], version)

    def test_blenders_own_modules_are_all_that_is_imported(self):
        """Beside the standard library and numpy; the module is optional."""
        allowed = {"bmesh", "bpy", "mathutils", "numpy", "shapespace"}
        standard = {
            "contextlib", "dataclasses", "json", "math", "os", "re", "secrets", "shutil", "struct",
            "subprocess", "tempfile", "threading", "time", "types",
        }  # fmt: skip
        for file in FOLDER.glob("*.py"):
            for name in re.findall(r"^\s*(?:import|from) (\w+)", file.read_text(), re.M):
                self.assertIn(name, allowed | standard, file)
