"""Every operator is one step of undo."""

import bpy
import numpy as np
from support import CUBE, CUBE_FACES, Case, add_object, bent_cube, select, state


class Undo(Case):
    def undone_and_redone(self, operator, **settings):
        bpy.ops.ed.undo_push(message="before")
        before = state()
        operator("EXEC_DEFAULT", True, **settings)
        after = state()
        self.assertNotEqual(after, before)
        bpy.ops.ed.undo()
        self.assertEqual(state(), before)
        bpy.ops.ed.redo()
        self.assertEqual(state(), after)

    def test_shape_keys(self):
        self.cube()
        self.undone_and_redone(bpy.ops.shapespace.inbetweens, shapes=2)
        # and a run that replaces another
        self.undone_and_redone(bpy.ops.shapespace.inbetweens, shapes=1, smooth=True)

    def test_extrapolation(self):
        self.cube()
        self.undone_and_redone(bpy.ops.shapespace.extrapolate, shapes=2, steps=1)

    def test_cache(self):
        self.cube()
        self.undone_and_redone(
            bpy.ops.shapespace.inbetweens, shapes=2, result="CACHE", cache_folder=str(self.folder)
        )

    def test_a_new_object(self):
        first = add_object("first", CUBE, CUBE_FACES)
        second = add_object("second", bent_cube(), CUBE_FACES)
        select(first, second)
        self.undone_and_redone(bpy.ops.shapespace.inbetweens, shapes=2)

    def test_bones(self):
        cube = self.cube()
        self.inbetweens(shapes=2)
        cube.select_set(True)
        self.undone_and_redone(bpy.ops.shapespace.bones, bones=3)

    def test_transfer(self):
        cube = self.cube()
        target = add_object("target", np.array(CUBE) * 1.25, CUBE_FACES)
        select(target, cube)
        self.undone_and_redone(bpy.ops.shapespace.transfer, shapes=2)
