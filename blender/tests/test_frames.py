"""The frames in which a motion is seen."""

import struct

import bpy
import numpy as np
from support import CUBE, CUBE_FACES, Case, add_key, add_object, bent_cube, curves, seen, select


class Frames(Case):
    def setUp(self):
        super().setUp()
        self.item = self.cube()
        self.wide = np.array(CUBE) * [2, 1, 1]

    def play(self, first, last):
        """Sets the scene's range."""
        scene = bpy.context.scene
        scene.frame_end = last  # before the start, which would move it
        scene.frame_start = first

    def reached(self, item):
        """The first and the last frame of the keyframes."""
        times = [time for curve in curves(item).values() for time, _ in curve]
        return min(times), max(times)

    def assert_fills(self, first, last, shapes):
        for i, frame in enumerate(self.frames([CUBE, bent_cube()], CUBE_FACES, "--shapes", shapes)):
            self.near(seen(self.item, first + i * (last - first) / (shapes + 1)), frame)
        self.assertGreater(np.abs(seen(self.item, first + 1) - CUBE).max(), 1e-3)
        self.assertGreater(np.abs(seen(self.item, last - 1) - bent_cube()).max(), 1e-3)

    def test_shape_keys_fill_the_scenes_range(self):
        for first, last in ((1, 250), (20, 41), (7, 9)):  # 83, 7 and 2/3 frames from shape to shape
            self.play(first, last)
            bpy.ops.shapespace.inbetweens(shapes=2)
            self.assert_fills(first, last, 2)

    def test_so_does_a_cache(self):
        self.play(20, 41)
        bpy.ops.shapespace.inbetweens(shapes=2, result="CACHE", cache_folder=str(self.folder))
        data = (self.folder / "cube.pc2").read_bytes()
        self.assertEqual(struct.unpack_from("<i", data, 28), (4,))
        self.assert_fills(20, 41, 2)

    def test_the_preview_range_is_what_is_played(self):
        scene = bpy.context.scene
        scene.use_preview_range = True
        scene.frame_preview_start, scene.frame_preview_end = 30, 60
        bpy.ops.shapespace.inbetweens(shapes=2)
        self.assertEqual(self.reached(self.item), (30, 60))

    def test_a_cyclic_motion_plays_as_a_loop(self):
        """Its first pose is shown again after the last frame."""
        add_key(self.item, "wide", self.wide)
        self.play(1, 60)
        bpy.ops.shapespace.inbetweens(shapes=3, smooth=True, cyclic=True)
        for frame, shape in ((1, CUBE), (21, bent_cube()), (41, self.wide), (61, CUBE)):
            self.near(seen(self.item, frame), shape)

    def test_extrapolated_and_transferred_motions_fill_it_too(self):
        self.play(10, 50)
        bpy.ops.shapespace.extrapolate(shapes=3, steps=2)
        self.assertEqual(self.reached(self.item), (10, 50))
        target = add_object("target", np.array(CUBE) * 1.25, CUBE_FACES)
        select(target, self.item)
        bpy.ops.shapespace.transfer(shapes=3)
        self.assertEqual(self.reached(target), (10, 50))

    def test_custom_frames_are_others(self):
        self.play(10, 50)
        bpy.ops.shapespace.inbetweens(shapes=3, custom_frames=True, frame_start=-5, frame_step=2)
        self.assertEqual(self.reached(self.item), (-5, 3))

    def test_a_scene_of_one_frame_has_no_room(self):
        self.play(7, 7)
        self.refused("7.*Custom Frames", bpy.ops.shapespace.inbetweens)
        bpy.ops.shapespace.inbetweens(shapes=1, custom_frames=True)
        self.near(seen(self.item, 3), bent_cube())
