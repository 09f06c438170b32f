"""In-betweens of several objects."""

import bpy
import numpy as np
from mathutils import Matrix
from support import (
    CUBE,
    CUBE_FACES,
    Case,
    add_key,
    add_object,
    bent_cube,
    key_names,
    placed,
    seen,
    select,
)


class Objects(Case):
    def two(self):
        """Two poses, the later one in the scene's list first in the order of names."""
        last = add_object("pose 10", bent_cube(), CUBE_FACES)
        first = add_object("pose 9", CUBE, CUBE_FACES)
        first.matrix_world = Matrix.Translation((0, 0, 4)) @ Matrix.Rotation(0.4, 4, "X")
        last.matrix_world = Matrix.Translation((3, 0, 0)) @ Matrix.Rotation(-0.3, 4, "Y")
        bpy.context.view_layer.update()
        select(first, last)
        return first, last

    def test_names_with_raised_digits(self):
        for other in ("a1²", "a1\u2460", "a\u0663"):
            first, last = self.two()
            first.name, last.name = "a1", other
            self.inbetweens(shapes=1)
            self.assertEqual(key_names(bpy.context.active_object)[0], "a1")
            for item in list(bpy.data.objects):
                bpy.data.objects.remove(item)

    def expected(self, first, last):
        shapes = [placed(item, seen(item, 1)) for item in (first, last)]
        return self.frames(shapes, CUBE_FACES, "--shapes", 3)

    def test_a_new_object_moves_through_them_in_the_scene(self):
        first, last = self.two()
        group = bpy.data.collections.new("group")
        bpy.context.scene.collection.children.link(group)
        group.objects.link(first)
        bpy.context.scene.collection.objects.unlink(first)
        material = bpy.data.materials.new("skin")
        first.data.materials.append(material)
        frames = self.expected(first, last)
        self.inbetweens(shapes=3)
        item = bpy.context.active_object
        self.assertEqual(bpy.context.selected_objects, [item])
        self.assertEqual(item.name, "pose 9 in-betweens")
        self.assertEqual(list(item.users_collection), [group])
        self.assertEqual(list(item.data.materials), [material])
        self.assertEqual(key_names(item)[:2], ["pose 9", "pose 10"])
        for i, frame in enumerate(frames):
            self.near(placed(item, seen(item, 1 + i)), frame)
        # The poses are as they were, and the operator can be run again on the new object.
        self.assertIsNone(first.data.shape_keys)
        objects = len(bpy.data.objects)
        self.inbetweens(shapes=1)
        self.assertEqual((len(key_names(item)), len(bpy.data.objects)), (3, objects))

    def test_cyclic_motion_ends_as_it_begins(self):
        first, last = self.two()
        shapes = [placed(item, seen(item, 1)) for item in (first, last)]
        self.inbetweens(shapes=3, smooth=True, cyclic=True)
        item = bpy.context.active_object
        self.assertEqual(len(key_names(item)), 8)  # two poses, three shapes in each of two gaps
        for frame, shape in ((1, shapes[0]), (5, shapes[1]), (9, shapes[0])):
            self.near(placed(item, seen(item, frame)), shape)

    def test_as_a_cache(self):
        first, last = self.two()
        frames = self.expected(first, last)
        self.inbetweens(shapes=3, result="CACHE", cache_folder=str(self.folder))
        item = bpy.context.active_object
        self.assertIsNone(item.data.shape_keys)
        for i, frame in enumerate(frames):
            self.near(placed(item, seen(item, 1 + i)), frame)
        self.assertTrue((self.folder / "pose 9 in-betweens.pc2").is_file())

    def test_a_cache_that_cannot_be_written_leaves_no_object(self):
        self.two()
        (self.folder / "pose 9 in-betweens.pc2").mkdir()
        meshes = len(bpy.data.meshes)
        self.refused(
            "cannot be written",
            bpy.ops.shapespace.inbetweens,
            result="CACHE",
            cache_folder=str(self.folder),
        )
        self.assertEqual(len(bpy.data.meshes), meshes)

    def test_objects_count_as_they_are_seen(self):
        """With modifiers, those that add vertices too, and with values of shape keys."""
        first = add_object("a", CUBE, CUBE_FACES)
        second = add_object("b", CUBE, CUBE_FACES)
        add_key(second, "bent", bent_cube()).value = 0.5
        for item in (first, second):
            item.modifiers.new("Subdivision", "SUBSURF").subdivision_type = "SIMPLE"
        ends = [seen(item, 1) for item in (first, second)]
        self.assertEqual(len(ends[0]), 26)
        select(first, second)
        self.inbetweens(shapes=1)
        item = bpy.context.active_object
        self.assertEqual(len(item.modifiers), 0)
        self.near(seen(item, 1), ends[0])
        self.near(seen(item, 3), ends[1])

    def test_other_things_that_are_selected_do_not_matter(self):
        light = bpy.data.objects.new("light", bpy.data.lights.new("light", "POINT"))
        bpy.context.scene.collection.objects.link(light)
        cube = self.cube()
        select(cube, light)
        self.inbetweens(shapes=1)
        self.near(seen(cube, 3), bent_cube())

    def test_meshes_that_do_not_correspond(self):
        first = add_object("first", CUBE, CUBE_FACES)
        shorter = add_object("shorter", CUBE[:7], [CUBE_FACES[0]])
        open_ = add_object("open", CUBE, CUBE_FACES[:5])
        turned = add_object("turned", CUBE, [CUBE_FACES[0][::-1], *CUBE_FACES[1:]])
        for other, text in (
            (shorter, "'first' has 8 vertices and 'shorter' 7: poses must be copies of one mesh"),
            (open_, "'first' has 6 faces and 'open' 5"),
            (turned, "'turned' connect other vertices than those of 'first'"),
        ):
            select(first, other)
            self.refused(text, bpy.ops.shapespace.inbetweens)

    def test_a_mirrored_pose(self):
        first = add_object("first", CUBE, CUBE_FACES)
        second = add_object("second", np.array(bent_cube()), CUBE_FACES)
        second.scale = (-1, 1, 1)
        select(first, second)
        self.refused("'first' or 'second' is mirrored.*positive", bpy.ops.shapespace.inbetweens)
