"""Bones that move a mesh as it moved without them."""

import bpy
import numpy as np
from mathutils import Matrix
from support import CUBE, CUBE_FACES, Case, add_key, add_object, placed, seen, select, state


class Bones(Case):
    def animal(self, shapes=7, last=9):
        (sit, stretch), faces = self.quadruped("sit", "stretch")
        animal = add_object("animal", sit, faces)
        add_key(animal, "stretch", stretch)
        self.inbetweens(shapes=shapes, frame_step=1, result="KEYS")
        bpy.context.scene.frame_end = last
        return animal

    def make(self, item, **settings):
        """The copy and its armature."""
        select(item)
        self.assertEqual(bpy.ops.shapespace.bones(**settings), {"FINISHED"})
        rig = bpy.context.active_object
        self.assertEqual((rig.type, bpy.context.selected_objects), ("ARMATURE", [rig]))
        (copy,) = rig.children
        return copy, rig

    def figures(self):
        shown = bpy.context.window_manager.shapespace_report
        return {figure.name: figure.value for figure in shown.figures}

    def error(self, item, copy, frames):
        """The root mean square distance of vertices in the scene at these frames, as a share of half
        the diagonal, and the greatest."""
        off = []
        for frame in frames:
            there = placed(item, seen(item, frame))
            off.append(np.linalg.norm(placed(copy, seen(copy, frame)) - there, axis=1))
        half = np.linalg.norm(np.ptp(placed(item, seen(item, frames[0])), axis=0)) / 2
        return np.sqrt(np.mean(np.square(off))) / half, np.max(off) / half

    def percent(self, name):
        return float(self.figures()[name].split()[0]) / 100

    def assert_reported(self, item, copy, frames):
        error, greatest = self.error(item, copy, frames)
        self.assertAlmostEqual(error, self.percent("Vertices off, rms"), delta=0.01 * error + 1e-5)
        self.assertAlmostEqual(
            greatest, self.percent("Vertices off, max"), delta=0.01 * greatest + 1e-5
        )
        return error

    def test_the_posed_armature_moves_the_mesh_as_its_shape_keys_did(self):
        animal = self.animal()
        before = state()
        copy, rig = self.make(animal, bones=12)
        self.assertEqual(len(rig.data.bones), 12)
        self.assertEqual(self.figures()["Bones"], "12")
        self.assertLess(self.assert_reported(animal, copy, range(1, 10)), 0.005)
        # Nothing else has changed.
        after = state()
        for name in ("animal",):
            self.assertEqual(after[name], before[name])

    def test_bones_are_a_tree_and_end_where_the_next_begins(self):
        _, rig = self.make(self.animal(), bones=12)
        bones = rig.data.bones
        self.assertEqual(len([bone for bone in bones if bone.parent is None]), 1)
        for bone in bones:
            self.assertGreater(bone.length, 0.01)
            if bone.children:
                gap = min((child.head_local - bone.tail_local).length for child in bone.children)
                self.assertLess(gap, 1e-5)

    def test_weights_are_vertex_groups_of_the_bones_with_sum_1(self):
        copy, rig = self.make(self.animal(), bones=6, bone_weights=2)
        groups = {group.index: group.name for group in copy.vertex_groups}
        self.assertEqual(sorted(groups.values()), sorted(rig.data.bones.keys()))
        for vertex in copy.data.vertices:
            self.assertLessEqual(len(vertex.groups), 2)
            self.assertAlmostEqual(sum(of.weight for of in vertex.groups), 1, places=5)

    def test_as_few_bones_as_the_error_needs(self):
        animal = self.animal()
        copy, rig = self.make(animal, auto_bones=True, bone_error=1)
        few = len(rig.data.bones)
        self.assertLess(self.assert_reported(animal, copy, range(1, 10)), 0.01)
        copy, rig = self.make(animal, auto_bones=True, bone_error=0.2)
        self.assertLess(self.assert_reported(animal, copy, range(1, 10)), 0.002)
        self.assertGreater(len(rig.data.bones), few)

    def test_bones_that_are_stretched(self):
        animal = self.animal()
        self.make(animal, bones=5)
        rigid = self.percent("Vertices off, rms")
        copy, rig = self.make(animal, bones=5, bone_scale=True)
        self.assertEqual((self.figures()["Bones"], len(rig.data.bones)), ("5", 10))
        self.assertLess(self.assert_reported(animal, copy, range(1, 10)), rigid)

    def test_a_mesh_cache_of_an_object_that_is_placed_and_moves_under_a_subdivision(self):
        cube = self.cube()
        cube.matrix_world = (
            Matrix.Translation((3, -20, 1)) @ Matrix.Rotation(0.7, 4, "X") @ Matrix.Diagonal((1, 2, 3, 1))
        )
        cube.vertex_groups.new(name="bone_01").add([0, 1], 1, "REPLACE")
        self.inbetweens(
            shapes=3, frame_step=2, result="CACHE", cache_folder=str(self.folder)
        )
        for frame, x in ((1, 3), (9, 8)):
            cube.location.x = x
            cube.keyframe_insert("location", frame=frame)
        added = cube.modifiers.new("Subdivision", "SUBSURF")
        added.subdivision_type = "SIMPLE"
        bpy.context.scene.frame_end = 9
        bpy.context.scene.frame_set(4)
        copy, rig = self.make(cube, bones=4)
        self.assertTrue(added.show_viewport)
        self.assertEqual(bpy.context.scene.frame_current, 4)
        self.assertEqual([m.type for m in copy.modifiers], ["ARMATURE", "SUBSURF"])
        self.assertEqual(len(copy.data.vertices), 8)
        self.assertEqual(set(copy.vertex_groups.keys()), {"bone_01", *rig.data.bones.keys()})
        for shown in (cube, copy):
            shown.modifiers["Subdivision"].show_viewport = False
        self.assert_reported(cube, copy, range(1, 10))

    def test_large_turns_between_keys(self):
        """Blender blends the numbers of a rotation, which turns unevenly."""
        bar = add_object("bar", [[x, y, 0] for x in range(9) for y in (0, 1)],
                         [[2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1] for i in range(8)])
        for frame, angle in ((1, 0), (21, np.radians(170))):
            bar.rotation_euler.z = angle
            bar.keyframe_insert("rotation_euler", frame=frame)
        for point in bar.animation_data.action.fcurves[2].keyframe_points:
            point.interpolation = "LINEAR"
        bpy.context.scene.frame_end = 21
        copy, rig = self.make(bar, bones=1)
        self.assertLess(self.error(bar, copy, range(1, 22))[1], 1e-3)
        turned = [c for c in rig.animation_data.action.fcurves if "rotation" in c.data_path]
        self.assertLess(len(turned[0].keyframe_points), 21)

    def test_frames_in_which_nothing_moves_are_left_out(self):
        animal = self.animal(shapes=1, last=60)
        _, rig = self.make(animal, bones=4)
        self.assertEqual(tuple(rig.animation_data.action.frame_range), (1, 3))
        _, rig = self.make(animal, bones=4, bone_step=2)
        self.assertEqual(tuple(rig.animation_data.action.frame_range), (1, 3))

    def test_what_is_missing(self):
        cube = add_object("cube", CUBE, CUBE_FACES)
        self.refused("'cube' does not move from frame 1 to 250", bpy.ops.shapespace.bones)
        bpy.ops.object.mode_set(mode="EDIT")
        self.refused("'cube' is in Edit Mode", bpy.ops.shapespace.bones)
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.context.view_layer.objects.active = None
        self.refused("The active object is no mesh", bpy.ops.shapespace.bones)
