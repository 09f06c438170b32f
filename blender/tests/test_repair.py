"""A distorted pose that gets back the geometry of a sound one."""

import bpy
import numpy as np
from support import CUBE, CUBE_FACES, Case, add_key, add_object, assign, key_names, key_shape, select


class Repair(Case):
    def blend(self):
        """An animal that stretches, and a shape key half way on straight lines."""
        (stretch, rear), faces = self.quadruped("stretch", "rear")
        animal = add_object("animal", stretch, faces)
        add_key(animal, "blend", (stretch + rear) / 2)
        animal.active_shape_key_index = 1
        return animal

    def off(self, item, key, sound=None):
        """How far the lengths of edges are from those of the Basis, rms."""
        edges = np.array([edge.vertices[:] for edge in item.data.edges])
        shapes = [key_shape(item, "Basis") if sound is None else sound, key_shape(item, key)]
        a, b = (np.linalg.norm(s[edges[:, 0]] - s[edges[:, 1]], axis=1) for s in shapes)
        return np.sqrt(((b / a - 1) ** 2).mean())

    def test_restores_lengths_and_keeps_the_pose(self):
        animal = self.blend()
        animal.data.shape_keys.key_blocks["blend"].value = 1
        bpy.ops.shapespace.repair()
        self.assertEqual(key_names(animal), ["Basis", "blend", "repaired"])
        self.assertLess(self.off(animal, "repaired"), 0.4 * self.off(animal, "blend"))
        shapes = [key_shape(animal, name) for name in key_names(animal)]
        self.assertLess(np.abs(shapes[2] - shapes[1]).mean(), np.abs(shapes[2] - shapes[0]).mean())
        # The repaired pose alone is seen.
        self.assertEqual([key.value for key in animal.data.shape_keys.key_blocks][1:], [0, 1])
        self.assertEqual(animal.active_shape_key.name, "repaired")

    def test_a_balance_decides_how_much(self):
        animal = self.blend()
        off = []
        for balance in (0.1, 0.9):
            animal.active_shape_key_index = 1
            bpy.ops.shapespace.repair(repair_balance=balance)
            off.append(self.off(animal, "repaired"))
        self.assertLess(off[1], 0.5 * off[0])

    def test_vertices_that_are_not_kept_are_ignored(self):
        animal = self.blend()
        shape = key_shape(animal, "blend")
        legs = assign(animal, "body", shape[:, 1] > 0.6) == 0
        bpy.ops.shapespace.repair(sound_group="body")
        once = key_shape(animal, "repaired")
        shape[legs] += [0.2, 0, 0]
        animal.data.shape_keys.key_blocks["blend"].data.foreach_set(
            "co", shape.astype("f4").reshape(-1)
        )
        animal.active_shape_key_index = 1
        bpy.ops.shapespace.repair(sound_group="body")
        self.near(key_shape(animal, "repaired"), once, 0.02)

    def test_by_another_object(self):
        """Which may stand elsewhere in the scene."""
        animal = self.blend()
        sound = key_shape(animal, "Basis")
        bpy.ops.shapespace.repair()
        once = key_shape(animal, "repaired")
        faces = [list(face.vertices) for face in animal.data.polygons]
        other = add_object("sound", sound, faces)
        other.location = (4, 0, 1)
        other.rotation_euler = (0, 0, 1)
        broken = add_object("broken", key_shape(animal, "blend"), faces)
        select(other, broken)
        bpy.ops.shapespace.repair()
        self.assertEqual(key_names(broken), ["Basis", "repaired"])
        self.near(key_shape(broken, "repaired"), once, 1e-4)

    def test_figures_of_the_report_are_shown(self):
        animal = self.blend()
        bpy.ops.shapespace.repair()
        shown = bpy.context.window_manager.shapespace_report
        figures = {figure.name: figure.value for figure in shown.figures}
        for name, key in (("before", "blend"), ("after", "repaired")):
            percent = float(figures[f"Edges {name}, rms"].rstrip(" %"))
            self.assertAlmostEqual(percent / (100 * self.off(animal, key)), 1, delta=0.5)

    def test_what_cannot_be_repaired(self):
        cube = add_object("cube", CUBE, CUBE_FACES)
        repair = bpy.ops.shapespace.repair
        self.refused("active shape key of 'cube' is no distorted pose: choose one", repair)
        add_key(cube, "bent", CUBE)
        cube.active_shape_key_index = 0
        self.refused("active shape key of 'cube' is no distorted pose", repair)
        cube.active_shape_key_index = 1
        self.refused("no vertex group 'x', which is to be kept", repair, sound_group="x")
        other = add_object("other", CUBE, CUBE_FACES[:5])
        select(other, cube)
        self.refused("'cube' has 6 faces and 'other' 5: poses must be copies", repair)
        third = add_object("third", CUBE, CUBE_FACES)
        third.scale = (-1, 1, 1)
        select(third, cube)
        self.refused("'cube' or 'third' is mirrored", repair)
        select(other, third, cube)
        self.refused("More than two meshes are selected", repair)
