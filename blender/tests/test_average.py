"""The average of poses, and its modes."""

import importlib.util
import unittest

import bpy
import numpy as np
from support import (
    CUBE,
    CUBE_FACES,
    Case,
    add_object,
    bent_cube,
    key_names,
    preferences,
    seen,
    select,
)


class Average(Case):
    def test_of_objects_is_a_new_object_between_them(self):
        first = add_object("pose 1", CUBE, CUBE_FACES)
        last = add_object("pose 2", bent_cube(), CUBE_FACES)
        select(first, last)
        bpy.ops.shapespace.average()
        item = bpy.context.active_object
        self.assertEqual(item.name, "pose 1 average")
        self.assertIsNone(item.data.shape_keys)
        self.assertEqual(bpy.context.selected_objects, [item])
        mean = seen(item, 1)
        for pose in (np.array(CUBE), np.array(bent_cube())):
            self.assertGreater(np.abs(mean - pose).max(), 1e-3)
        # An average of the average and itself is the average.
        copy = add_object("again", mean, CUBE_FACES)
        select(item, copy)
        bpy.ops.shapespace.average()
        np.testing.assert_allclose(seen(bpy.context.active_object, 1), mean, atol=1e-4)

    def test_modes_are_shape_keys(self):
        self.cube()
        bpy.ops.shapespace.average(modes=1)
        made = bpy.context.active_object
        self.assertEqual(made.name, "cube average")
        self.assertEqual(key_names(made), ["Basis", "Mode 1"])
        # At a standard deviation to either side are the two poses.
        blocks = made.data.shape_keys.key_blocks
        self.assertEqual((blocks["Mode 1"].slider_min, blocks["Mode 1"].slider_max), (-3, 3))
        mean = seen(made, 1)
        blocks["Mode 1"].value = 1
        moved = seen(made, 1)
        self.assertGreater(np.abs(moved - mean).max(), 1e-3)

    def test_too_many_modes_are_refused(self):
        item = self.cube()
        with self.assertRaisesRegex(RuntimeError, "must be at most 1"):
            bpy.ops.shapespace.average(modes=2)
        self.assertEqual(bpy.context.active_object, item)

    @unittest.skipIf(importlib.util.find_spec("shapespace") is None, "the Python module is not there")
    def test_the_module_makes_the_same(self):
        item = self.cube()
        bpy.ops.shapespace.average(modes=1)
        made = bpy.context.active_object
        made.data.shape_keys.key_blocks["Mode 1"].value = 1
        by_tools = seen(made, 1)
        preferences().engine = "MODULE"
        select(item)
        bpy.ops.shapespace.average(modes=1)
        made = bpy.context.active_object
        made.data.shape_keys.key_blocks["Mode 1"].value = 1
        np.testing.assert_allclose(seen(made, 1), by_tools, atol=1e-4)
