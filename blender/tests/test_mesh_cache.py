"""In-betweens as point caches."""

import struct
import unittest.mock

import bpy
import numpy as np
from support import CUBE, Case, add_key, add_object, bent_cube, key_names, seen


class MeshCache(Case):
    def save(self, name="scene.blend"):
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / name))

    def test_quadruped_moves_as_the_frames_of_the_tool(self):
        (sit, stretch), faces = self.quadruped("sit", "stretch")
        animal = add_object("animal", sit, faces)
        add_key(animal, "stretch", stretch)
        self.inbetweens(
            shapes=7, result="CACHE", cache_folder=str(self.folder), frame_start=10, frame_step=3
        )
        frames = self.frames([sit, stretch], faces, "--shapes", 7)
        for i, frame in enumerate(frames):
            self.near(seen(animal, 10 + 3 * i), frame)
        self.near(seen(animal, 14), (2 * frames[1] + frames[2]) / 3)
        self.near(seen(animal, -20), sit)
        self.near(seen(animal, 90), stretch)

    def test_cyclic_motion_ends_as_it_begins(self):
        cube = self.cube()
        self.inbetweens(
            shapes=3, result="CACHE", cache_folder=str(self.folder), smooth=True, cyclic=True
        )
        for frame, shape in ((1, CUBE), (5, bent_cube()), (9, CUBE)):
            self.near(seen(cube, frame), shape)

    def test_the_file_is_a_point_cache_in_coordinates_of_the_object(self):
        cube = self.cube()
        cube.location = (10, 0, 0)
        self.inbetweens(shapes=1, result="CACHE", cache_folder=str(self.folder))
        data = (self.folder / "cube.pc2").read_bytes()
        self.assertEqual(
            struct.unpack_from("<12siiffi", data), (b"POINTCACHE2\0", 1, 8, 0, 1, 3)
        )
        shapes = np.frombuffer(data, "<f4", offset=32).reshape(3, 8, 3)
        self.near(shapes[0], CUBE)
        self.near(shapes[2], bent_cube())

    def test_drivers_of_keys_do_not_matter(self):
        cube = self.cube()
        driver = cube.data.shape_keys.key_blocks["bent"].driver_add("value").driver
        driver.expression = "0.5"
        work = self.begin(shapes=1, result="CACHE", cache_folder=str(self.folder))
        work.wait()
        (note,) = work.finish(bpy.context)
        self.assertIn("'bent'", note)
        self.near(seen(cube, 1), CUBE)
        self.near(seen(cube, 3), bent_cube())

    def test_beside_the_blend_and_found_after_both_are_moved(self):
        cube = self.cube("a/b")
        self.save("walk.blend")
        self.inbetweens(shapes=1, result="CACHE")
        shown = seen(cube, 2)
        self.assertGreater(np.abs(shown - seen(cube, 1)).max(), 0.1)
        bpy.ops.wm.save_mainfile()
        self.assertTrue((self.folder / "walk-a%2Fb.pc2").is_file())
        moved = self.folder / "moved"
        moved.mkdir()
        for name in ("walk.blend", "walk-a%2Fb.pc2"):
            (self.folder / name).rename(moved / name)
        bpy.ops.wm.open_mainfile(filepath=str(moved / "walk.blend"))
        self.near(seen(bpy.data.objects["a/b"], 2), shown)

    def test_objects_of_different_names_have_different_caches(self):
        names = ["a/b", "a:b", "a_b", "a%2Fb", "a\\b", "a\nb"]
        for name in names:
            self.cube(name)
            self.inbetweens(shapes=1, result="CACHE", cache_folder=str(self.folder))
        self.assertEqual(len(list(self.folder.iterdir())), len(names))

    def test_a_drive_that_is_missing(self):
        self.cube()
        with unittest.mock.patch("os.path.exists", return_value=False), unittest.mock.patch(
            "os.path.isdir", return_value=False
        ):
            self.refused(
                "Nothing can be written to .*: choose another folder",
                bpy.ops.shapespace.inbetweens,
                result="CACHE",
                cache_folder=str(self.folder / "away"),
            )

    def test_comes_before_other_modifiers_and_is_used_again(self):
        cube = self.cube()
        cube.modifiers.new("Subdivision", "SUBSURF")
        for count in (1, 3):
            self.inbetweens(
                shapes=count, result="CACHE", cache_folder=str(self.folder)
            )
            self.assertEqual([m.type for m in cube.modifiers], ["MESH_CACHE", "SUBSURF"])
        self.assertEqual(key_names(cube), ["Basis", "bent"])
        cube.modifiers.remove(cube.modifiers["Subdivision"])
        self.near(seen(cube, 5), bent_cube())

    def test_shape_keys_afterwards_are_seen(self):
        cube = self.cube()
        self.inbetweens(shapes=1, result="CACHE", cache_folder=str(self.folder))
        self.inbetweens(shapes=1, frame_start=50)
        self.assertEqual(len(cube.modifiers), 0)
        self.near(seen(cube, 52), bent_cube())
        self.near(seen(cube, 3), CUBE)

    def test_folders_that_are_missing_are_made(self):
        self.cube()
        folder = self.folder / "new" / "caches"
        self.inbetweens(shapes=1, result="CACHE", cache_folder=str(folder))
        self.assertEqual([file.name for file in folder.iterdir()], ["cube.pc2"])

    def test_a_scene_that_is_not_saved_has_no_place_for_it(self):
        self.cube()
        self.refused(
            "not saved yet: save it, or choose a folder",
            bpy.ops.shapespace.inbetweens,
            result="CACHE",
        )

    def test_a_file_in_place_of_the_folder(self):
        self.cube()
        (self.folder / "file").write_text("")
        self.refused(
            "choose another folder",
            bpy.ops.shapespace.inbetweens,
            result="CACHE",
            cache_folder=str(self.folder / "file"),
        )

    def test_a_folder_in_place_of_the_file(self):
        self.cube()
        (self.folder / "cube.pc2").mkdir()
        self.refused(
            "cannot be written: .*; choose another folder",
            bpy.ops.shapespace.inbetweens,
            shapes=1,
            result="CACHE",
            cache_folder=str(self.folder),
        )
        self.assertEqual([file.name for file in self.folder.iterdir()], ["cube.pc2"])
