"""Library overrides: objects that are linked from another file, and may be changed here."""

import bpy
from support import CUBE, CUBE_FACES, Case, bent_cube, key_names, linked_from_file, seen, select


class Overrides(Case):
    def override(self):
        """A cube with a modifier, from another file; its mesh is linked."""
        cube = self.cube()
        cube.modifiers.new("Subdivision", "SUBSURF").show_viewport = False
        linked = linked_from_file(self.folder / "library.blend", "cube")
        cube = linked.override_create(remap_local_usages=True)
        select(cube)
        return cube

    def make_cache(self, **settings):
        self.inbetweens(
            shapes=1, result="CACHE", cache_folder=str(self.folder), **settings
        )

    def saved_and_opened(self):
        """The object that is not linked, after the file was saved and opened."""
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "scene.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(self.folder / "scene.blend"))
        (cube,) = [item for item in bpy.data.objects if item.library is None]
        return cube

    def assert_moves(self, cube):
        self.assertEqual([m.type for m in cube.modifiers], ["MESH_CACHE", "SUBSURF"])
        for i, frame in enumerate(self.frames([CUBE, bent_cube()], CUBE_FACES, "--shapes", 1)):
            self.near(seen(cube, 1 + i), frame)

    def test_a_cache_moves_it_and_is_saved(self):
        cube = self.override()
        self.make_cache()
        self.assert_moves(cube)
        cube = self.saved_and_opened()
        self.assertIsNotNone(cube.override_library)
        self.assert_moves(cube)

    def test_so_does_one_whose_mesh_is_an_override(self):
        cube = self.override()
        cube.data.override_create(remap_local_usages=True)
        self.make_cache()
        self.assert_moves(self.saved_and_opened())

    def test_shape_keys_which_would_not_be_saved_are_refused(self):
        cube = self.override()
        self.refused("'cube'.*Mesh Cache", bpy.ops.shapespace.inbetweens)
        cube.data.override_create(remap_local_usages=True)
        self.refused("'cube'.*Mesh Cache", bpy.ops.shapespace.inbetweens)
        cube.shape_key_add(name="added")
        self.assertEqual(key_names(self.saved_and_opened()), ["Basis", "bent"])

    def test_with_a_mesh_of_this_file_it_can_have_shape_keys(self):
        cube = self.override()
        cube.data = cube.data.copy()
        self.inbetweens(shapes=1)
        cube = self.saved_and_opened()
        self.assertEqual(key_names(cube), ["Basis", "bent", "geo 001"])
        self.near(seen(cube, 3), bent_cube())

    def test_one_that_cannot_be_edited_is_refused(self):
        cube = self.override()
        cube.override_library.is_system_override = True
        self.refused(
            "'cube'",
            bpy.ops.shapespace.inbetweens,
            result="CACHE",
            cache_folder=str(self.folder),
        )
