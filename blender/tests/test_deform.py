"""A mesh deformed by handles."""

import json
import math

import bpy
import numpy as np
from mathutils import Matrix, Vector
from support import (
    CUBE,
    CUBE_FACES,
    Case,
    add_key,
    add_object,
    assign,
    key_names,
    key_shape,
    placed,
    read_obj,
    seen,
    select,
    tool,
    write_obj,
)


class Deform(Case):
    def animal(self, triangles=1500):
        """A standing animal, with vertex groups of its feet and its head."""
        (stand,), faces = self.quadruped("stand", triangles=triangles)
        animal = add_object("animal", stand, faces)
        self.feet = assign(animal, "feet", stand[:, 1] < 0.1)
        self.head = assign(animal, "head", (stand[:, 1] > 1.2) & (stand[:, 2] > 0.6))
        return animal

    def with_handles(self):
        """The animal with fixed feet, and the empty that its head follows."""
        animal = self.animal()
        empty = self.add_handles(animal)
        return animal, empty

    def add_handles(self, animal):
        animal.vertex_groups.active = animal.vertex_groups["feet"]
        bpy.ops.shapespace.handle_add(moves="FIXED")
        animal.vertex_groups.active = animal.vertex_groups["head"]
        bpy.ops.shapespace.handle_add(moves="EMPTY")
        return animal.shapespace_handles[1].target

    def test_a_new_empty_is_in_the_middle_of_its_vertices(self):
        animal = self.animal()
        animal.matrix_world = Matrix.Translation((3, 0, 1)) @ Matrix.Diagonal((2, 1, 1, 1))
        empty = self.add_handles(animal)
        middle = placed(animal, seen(animal, 1))[self.head].mean(axis=0)
        self.near(list(empty.matrix_world.translation), middle)
        self.assertEqual(list(empty.users_collection), list(animal.users_collection))

    def test_held_vertices_are_where_their_handles_are(self):
        animal, empty = self.with_handles()
        rest = seen(animal, 1)
        empty.location += Vector((0.2, 0.1, 0))
        bpy.ops.shapespace.deform()
        self.assertEqual(key_names(animal), ["Basis", "deformed"])
        now = seen(animal, 1)
        self.near(now[self.feet], rest[self.feet])
        self.near(now[self.head], rest[self.head] + [0.2, 0.1, 0])
        neck = ~self.head & ~self.feet
        self.assertGreater(np.abs(now - rest)[neck].max(), 0.05)

    def test_the_empty_may_be_active(self):
        animal, empty = self.with_handles()
        empty.location.x += 0.1
        select(empty)
        bpy.ops.shapespace.deform()
        self.assertEqual(key_names(animal), ["Basis", "deformed"])
        self.assertEqual(bpy.context.active_object, empty)

    def test_an_empty_that_turns_turns_its_vertices_about_itself(self):
        animal, empty = self.with_handles()
        rest = seen(animal, 1)
        centre = np.array(empty.location)
        empty.rotation_euler = (0, math.radians(30), 0)
        bpy.ops.shapespace.deform()
        turn = np.array(Matrix.Rotation(math.radians(30), 3, "Y"))
        self.near(seen(animal, 1)[self.head], (rest[self.head] - centre) @ turn.T + centre)

    def test_is_what_the_tool_makes_of_a_file_of_handles(self):
        animal, empty = self.with_handles()
        centre = [float(x) for x in empty.location]
        empty.location += Vector((0.1, 0, 0))
        empty.rotation_euler = (0, 0, 0.5)
        bpy.ops.shapespace.deform(
            deform_shapes=3, custom_volume=True, volume=3, custom_bending=True, bending=1e-4
        )
        numbers = [(np.flatnonzero(group) + 1).tolist() for group in (self.feet, self.head)]
        handles = [
            {"fixed": True, "select": {"vertices": numbers[0]}},
            {
                "translation": [0.1, 0, 0],
                "rotation": {"axis": [0, 0, 1], "degrees": math.degrees(0.5), "point": centre},
                "select": {"vertices": numbers[1]},
            },
        ]
        (self.folder / "handles.json").write_text(json.dumps({"handles": handles}))
        write_obj(
            self.folder / "rest.obj", key_shape(animal, "Basis"),
            [list(face.vertices) for face in animal.data.polygons],
        )  # fmt: skip
        tool(
            "shape-deform", "rest.obj", "--handles", "handles.json", "--shapes", 3, "--volume", 3,
            "--bending", 1e-4, "--output", "bent.obj", cwd=self.folder,
        )  # fmt: skip
        self.near(key_shape(animal, "deformed"), read_obj(self.folder / "bent.obj")[0], 1e-4)

    def test_does_not_depend_on_where_all_of_it_stands(self):
        """The object and its handles moved together, and turned, between two runs."""
        animal, empty = self.with_handles()
        empty.location += Vector((0.2, 0.1, 0))
        empty.rotation_euler = (0, 0.3, 0)
        bpy.ops.shapespace.deform()
        once = key_shape(animal, "deformed")
        bpy.context.view_layer.update()
        motion = Matrix.Translation((5, -2, 1)) @ Matrix.Rotation(1.1, 4, Vector((1, 2, 3)))
        for item in (animal, empty):
            item.matrix_world = motion @ item.matrix_world
        bpy.ops.shapespace.deform()
        self.near(key_shape(animal, "deformed"), once, 1e-4)

    def test_a_scaled_object_is_deformed_as_it_stands_in_the_scene(self):
        """The same as for an object whose mesh has that scale."""
        found = []
        scale = np.array([1.5, 1, 0.8])
        for applied in (False, True):
            animal = self.animal()
            if applied:
                rest = seen(animal, 1) * scale
                animal.data.vertices.foreach_set("co", rest.astype("f4").reshape(-1))
            else:
                animal.scale = scale
            empty = self.add_handles(animal)
            empty.location += Vector((0.2, 0.1, 0))
            empty.rotation_euler = (0.4, 0, 0)
            bpy.ops.shapespace.deform()
            found.append(placed(animal, seen(animal, 1)))
            for item in (animal, empty):
                bpy.data.objects.remove(item)
        self.near(*found, 1e-4)

    def test_an_empty_that_belongs_to_the_object_moves_with_it(self):
        animal, empty = self.with_handles()
        bpy.context.view_layer.update()
        world = empty.matrix_world.copy()
        empty.parent = animal
        empty.matrix_world = world
        animal.location = (3, 2, 1)
        rest = seen(animal, 1)
        bpy.ops.shapespace.deform()
        self.near(key_shape(animal, "deformed"), rest)

    def test_a_soft_handle_yields(self):
        animal, empty = self.with_handles()
        rest = seen(animal, 1)
        handle = animal.shapespace_handles[1]
        handle.soft = True
        empty.location.x += 0.3
        moved = []
        for balance in (0.01, 0.5):
            bpy.ops.shapespace.deform(balance=balance)
            moved.append((seen(animal, 1) - rest)[self.head, 0].mean())
        self.assertTrue(0.3 > moved[0] > moved[1] > 0.01, moved)

    def test_a_stiff_part_bends_less(self):
        """The pulled half of a bar of which the middle is stiff, or not."""
        tool("shape-body", "bar", "--at", 0, "--output", "bar%d.obj", cwd=self.folder)
        rest, faces = read_obj(self.folder / "bar0.obj")
        bar = add_object("bar", rest, faces)
        assign(bar, "feet", rest[:, 0] < -2.4)
        assign(bar, "head", rest[:, 0] > 2.4)
        middle = assign(bar, "middle", np.abs(rest[:, 0]) < 0.8)
        empty = self.add_handles(bar)
        empty.location.z += 1.5
        bends = []
        for group in ("", "middle"):
            bpy.ops.shapespace.deform(stiffness_group=group, stiffness_factor=100)
            bends.append(_distance_from_rigid(rest[middle], seen(bar, 1)[middle]))
        self.assertLess(bends[1], 0.3 * bends[0])

    def test_a_second_run_replaces_the_result_and_a_renamed_key_is_the_users(self):
        animal, empty = self.with_handles()
        empty.location.x += 0.1
        bpy.ops.shapespace.deform()
        empty.location.x += 0.1
        bpy.ops.shapespace.deform()
        self.assertEqual(key_names(animal), ["Basis", "deformed"])
        animal.data.shape_keys.key_blocks["deformed"].name = "greeting"
        greeting = key_shape(animal, "greeting")
        empty.location.x -= 0.3
        bpy.ops.shapespace.deform()
        self.assertEqual(key_names(animal), ["Basis", "greeting", "deformed"])
        self.near(key_shape(animal, "greeting"), greeting, 0)

    def test_the_result_is_a_pose_for_in_betweens(self):
        animal, empty = self.with_handles()
        empty.location.x += 0.1
        bpy.ops.shapespace.deform()
        deformed = key_shape(animal, "deformed")
        self.inbetweens(shapes=3)
        self.near(seen(animal, 5), deformed)

    def test_figures_of_the_report_are_shown(self):
        _, empty = self.with_handles()
        empty.location.x += 0.1
        bpy.ops.shapespace.deform()
        shown = bpy.context.window_manager.shapespace_report
        figures = {figure.name: figure.value for figure in shown.figures}
        self.assertEqual((shown.title, figures["Ended"]), ("Deform", "converged"))
        self.assertLess(float(figures["head off, rms"]), 1e-6)
        self.assertGreater(float(figures["Edges off, rms"].rstrip(" %")), 0.1)

    def test_what_is_wrong_with_handles(self):
        animal, empty = self.with_handles()
        deform = bpy.ops.shapespace.deform
        feet, head = animal.shapespace_handles
        for change, back, text in (
            (lambda: setattr(feet, "vertex_group", "paws"),
             lambda: setattr(feet, "vertex_group", "feet"),
             "'animal' has no vertex group 'paws', which is a handle: choose another"),
            (lambda: setattr(feet, "vertex_group", ""),
             lambda: setattr(feet, "vertex_group", "feet"),
             "Handle 1 of 'animal' has no vertex group: choose one"),
            (lambda: animal.vertex_groups["feet"].remove(range(len(animal.data.vertices))),
             lambda: assign(animal, "feet", self.feet),
             "No vertex of 'animal' has a weight of 0.5 or more in the vertex group 'feet'"),
            (lambda: setattr(head, "target", None),
             lambda: setattr(head, "target", empty),
             "'head' of 'animal' has no target: choose an empty"),
            (lambda: setattr(head, "target", animal),
             lambda: setattr(head, "target", empty),
             "'head' of 'animal' has the mesh itself as its target"),
            (lambda: empty.users_collection[0].objects.unlink(empty),
             lambda: bpy.context.scene.collection.objects.link(empty),
             "'head handle' of a handle of 'animal' is not in this scene"),
            (lambda: setattr(empty, "scale", (2, 2, 2)),
             lambda: setattr(empty, "scale", (1, 1, 1)),
             "'head handle' was scaled, but handles only move and turn"),
            (lambda: setattr(empty, "scale", (1, 0, 1)),
             lambda: setattr(empty, "scale", (1, 1, 1)),
             "'head handle' is scaled to zero"),
            (lambda: setattr(animal, "scale", (-1, 1, 1)),
             lambda: setattr(animal, "scale", (1, 1, 1)),
             "'head handle' or 'animal' was mirrored since"),
            (lambda: bpy.ops.object.mode_set(mode="EDIT"),
             lambda: bpy.ops.object.mode_set(mode="OBJECT"),
             "'animal' is in Edit Mode: change to Object Mode"),
        ):  # fmt: skip
            with self.subTest(text):
                change()
                self.refused(text, deform)
                back()
        bpy.ops.shapespace.deform()

    def test_what_is_wrong_with_the_mesh(self):
        self.refused("The active object is no mesh", bpy.ops.shapespace.deform)
        cube = add_object("cube", CUBE, CUBE_FACES)
        self.refused("'cube' has no handles: add one", bpy.ops.shapespace.deform)
        self.refused("'cube' has no handles", bpy.ops.shapespace.handle_remove)
        self.refused("'cube' has no vertex group: assign", bpy.ops.shapespace.handle_add)
        assign(cube, "all", np.ones(8, bool))
        bpy.ops.shapespace.handle_add()
        self.refused(
            "'cube' has no vertex group 'hard', which is stiffer",
            bpy.ops.shapespace.deform,
            stiffness_group="hard",
        )
        add_key(cube, "bent", CUBE)
        cube.data.shape_keys.use_relative = False
        self.refused("'cube' are absolute", bpy.ops.shapespace.deform)

    def test_a_cache_that_hides_shape_keys(self):
        animal, empty = self.with_handles()
        add_key(animal, "twin", seen(animal, 1))
        self.inbetweens(
            shapes=1, result="CACHE", cache_folder=str(self.folder)
        )
        self.refused("plays a point cache, which hides shape keys", bpy.ops.shapespace.deform)
        animal.modifiers["shapespace"].show_viewport = False
        bpy.ops.shapespace.deform()

    def test_set_rest_begins_where_targets_are(self):
        animal, empty = self.with_handles()
        rest = seen(animal, 1)
        empty.location.x += 1
        empty.scale = (2, 2, 2)
        bpy.ops.shapespace.handles_set_rest()
        bpy.ops.shapespace.deform()
        self.near(seen(animal, 1), rest)

    def test_a_handle_is_removed(self):
        animal, empty = self.with_handles()
        animal.shapespace_active_handle = 0
        bpy.ops.shapespace.handle_remove()
        self.assertEqual([h.vertex_group for h in animal.shapespace_handles], ["head"])
        self.assertIn("feet", animal.vertex_groups)
        self.assertIn(empty.name, bpy.data.objects)

    def test_handles_are_saved_with_the_file(self):
        animal, empty = self.with_handles()
        empty.location.x += 0.2
        bpy.ops.shapespace.deform()
        once = key_shape(animal, "deformed")
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "scene.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(self.folder / "scene.blend"))
        animal = bpy.data.objects["animal"]
        select(animal)
        animal.shape_key_remove(animal.data.shape_keys.key_blocks["deformed"])
        bpy.ops.shapespace.deform()
        self.near(key_shape(animal, "deformed"), once)


def _distance_from_rigid(a, b):
    """How far the points b are from a rigid motion of a, rms."""
    a, b = a - a.mean(axis=0), b - b.mean(axis=0)
    left, _, right = np.linalg.svd(a.T @ b)
    left[:, -1] *= np.sign(np.linalg.det(left @ right))
    return np.sqrt(((a @ left @ right - b) ** 2).sum(axis=1).mean())
