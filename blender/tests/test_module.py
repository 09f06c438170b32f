"""The Python module in place of the tools. Skipped where it cannot be imported."""

import importlib.util
import threading
import time
import unittest

import bpy
import numpy as np
from support import (
    CUBE,
    CUBE_FACES,
    Case,
    add_key,
    add_object,
    assign,
    bent_cube,
    children,
    key_names,
    key_shape,
    preferences,
    select,
    state,
)

MODULE = importlib.util.find_spec("shapespace")


@unittest.skipIf(MODULE is None, "the Python module is not there: ./dev python builds it")
class Module(Case):
    def both(self, item, operator, **settings):
        """The shape keys that an object gets from the tools, and from the module."""
        found = []
        for engine in ("TOOLS", "MODULE"):
            preferences().engine = engine
            operator(**settings)
            found.append([key_shape(item, name) for name in key_names(item)])
        return found

    def test_makes_what_the_tools_make(self):
        (stand, rear), faces = self.quadruped("stand", "rear")
        (long,), _ = self.quadruped("stand", proportions="long")
        animal = add_object("animal", stand, faces)
        add_key(animal, "rear", rear)
        for operator, settings in (
            (bpy.ops.shapespace.inbetweens, {"shapes": 3}),
            (bpy.ops.shapespace.inbetweens, {"shapes": 3, "metric": "rigid"}),
            (bpy.ops.shapespace.inbetweens, {"shapes": 3, "smooth": True, "cyclic": True}),
            (bpy.ops.shapespace.inbetweens, {"shapes": 3, "avoid_contact": True}),
            (bpy.ops.shapespace.extrapolate, {"shapes": 3, "steps": 2}),
        ):
            self.near(*self.both(animal, operator, **settings))
        target = add_object("target", long, faces)
        select(target, animal)
        for poses_only in (False, True):
            shapes = self.both(
                target, bpy.ops.shapespace.transfer, shapes=3, poses_only=poses_only
            )
            self.near(*shapes)

    def test_deforms_and_repairs_as_the_tools_do(self):
        (stand, rear), faces = self.quadruped("stand", "rear")
        animal = add_object("animal", stand, faces)
        feet = assign(animal, "feet", stand[:, 1] < 0.1)
        bpy.ops.shapespace.handle_add(moves="FIXED")
        assign(animal, "head", stand[:, 1] > 1.3)
        animal.vertex_groups.active_index = 1
        bpy.ops.shapespace.handle_add(moves="EMPTY")
        head = animal.shapespace_handles[1]
        head.target.location.x += 0.2
        head.target.rotation_euler = (0.3, 0, 0)
        options = {"custom_bending": True, "bending": 1e-4, "stiffness_group": "head"}
        # Angles in degrees are rounded, so each engine has to end near the least energy, not on its way.
        exact = {"custom_tolerance": True, "tolerance": 1e-12}
        for soft in (False, True):
            head.soft = soft
            for settings in ({}, {"deform_shapes": 2, "balance": 0.1, **options}):
                self.near(*self.both(animal, bpy.ops.shapespace.deform, **settings, **exact))
        add_key(animal, "blend", (stand + rear) / 2)
        found = []
        for engine in ("TOOLS", "MODULE"):
            preferences().engine = engine
            for settings in ({}, {"sound_group": "feet", "repair_balance": 0.8, **options}):
                animal.active_shape_key_index = key_names(animal).index("blend")
                bpy.ops.shapespace.repair(**settings)
                found.append(key_shape(animal, "repaired"))
        self.near(found[:2], found[2:])
        self.assertGreater(np.abs(found[1] - found[0])[feet].max(), 1e-3)

    def test_settings_of_motions(self):
        cube = self.cube()
        assign(cube, "foot", np.array(CUBE)[:, 2] < 0)
        self.near(
            *self.both(
                cube, bpy.ops.shapespace.inbetweens, shapes=3, anchor_group="foot", ground=True,
                ground_height=2, stiffness_group="foot", custom_volume=True, volume=1,
                custom_tolerance=True, tolerance=1e-8,
            )
        )  # fmt: skip

    def test_smooth_motion(self):
        cube = self.cube()
        add_key(cube, "wide", np.array(CUBE) * [2, 1, 1])
        operator = bpy.ops.shapespace.inbetweens
        chain, _ = self.both(cube, operator, shapes=3)
        for cyclic in (False, True):
            tools, module = self.both(cube, operator, shapes=3, smooth=True, cyclic=cyclic)
            self.near(tools, module)
            self.assertGreater(np.abs(tools[3] - chain[3]).max(), 1e-3)
        add_key(cube, "again", CUBE)
        self.refused("the last pose is the first: leave it out", operator, smooth=True, cyclic=True)

    def test_motion_round_contact(self):
        # A rope bent to a ring, whose ends overlap: one in front of the other, or behind it.
        turns = np.linspace(0, 1.1, 61)
        angle, poses = 2 * np.pi * turns, []
        for side in (0.6, -0.6):
            edges = []
            for out, aside in ((0, -1), (1, 0), (0, 1), (-1, 0)):
                radius = 1 + 0.15 * turns + 0.15 * out
                along = side * turns + 0.15 * aside
                edges.append(np.stack([radius * np.sin(angle), along, -radius * np.cos(angle)], 1))
            poses.append(np.concatenate(edges))
        n = len(turns)
        faces = [
            (row * n + i, row * n + i + 1, (row + 1) % 4 * n + i + 1, (row + 1) % 4 * n + i)
            for row in range(4)
            for i in range(n - 1)
        ]
        rope = add_object("rope", poses[0], faces)
        add_key(rope, "behind", poses[1])
        operator = bpy.ops.shapespace.inbetweens
        found = self.both(rope, operator, shapes=5, avoid_contact=True)
        through, _ = self.both(rope, operator, shapes=5)
        for shapes in found:
            self.assertGreater(np.abs(shapes[4] - through[4]).max(), 0.05)
        self.both(rope, operator, shapes=5, smooth=True, avoid_contact=True)

    def test_quadrilaterals_and_edges(self):
        cube = add_object("cube", [*CUBE, [0, 0, 3]], CUBE_FACES, [(1, 8)])
        add_key(cube, "bent", [*bent_cube(), [0, 1, 3]])
        self.near(*self.both(cube, bpy.ops.shapespace.inbetweens, shapes=2))

    def test_a_rope_of_edges(self):
        rope = add_object("rope", [[i, 0, 0] for i in range(4)], [], [(0, 1), (1, 2), (2, 3)])
        add_key(rope, "curled", [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
        self.near(*self.both(rope, bpy.ops.shapespace.inbetweens, shapes=1))

    def test_runs_while_blender_waits_and_is_cancelled(self):
        (sit, stretch), faces = self.quadruped("sit", "stretch", triangles=20000)
        add_key(add_object("animal", sit, faces), "stretch", stretch)
        preferences().engine = "MODULE"
        before, threads = state(), threading.active_count()
        work = self.begin(shapes=63)
        self.assertEqual(children(), [])
        while not work.share:
            self.assertFalse(work.poll())
            time.sleep(0.01)
        work.cancel()
        self.wait_for(lambda: threading.active_count() <= threads)
        self.assertEqual(state(), before)

    def test_fits_as_the_tools_do(self):
        (stand,), faces = self.quadruped("stand")
        (stride,), others = self.quadruped("stride", triangles=2500)
        target, template = add_object("target", stride, others), add_object("template", stand, faces)
        for marked in (False, True):
            if marked:
                for item, shape in ((target, stride), (template, stand)):
                    assign(item, "fit marker", np.arange(len(shape)) == shape[:, 2].argmin())
            found = []
            for engine in ("TOOLS", "MODULE"):
                preferences().engine = engine
                select(target, template)
                bpy.ops.shapespace.fit()
                fitted = bpy.data.objects["template as target"]
                found.append([tuple(vertex.co) for vertex in fitted.data.vertices])
                bpy.data.objects.remove(fitted)
            self.near(*found, 1e-4)

    def test_its_errors_are_reports(self):
        cube = add_object("cube", CUBE, CUBE_FACES)
        add_key(cube, "inside out", np.array(CUBE) * [-1, 1, 1])
        preferences().engine = "MODULE"
        self.refused("'inside out' against 'Basis'.* mirror", bpy.ops.shapespace.inbetweens)

    def test_what_looks_like_a_mirror_image_is_taken_if_allowed(self):
        cube = add_object("cube", CUBE, CUBE_FACES)
        add_key(cube, "inside out", np.array(CUBE) * [-1, 1, 1])
        tools, module = self.both(
            cube, bpy.ops.shapespace.inbetweens, shapes=1, allow_mirrored=True
        )
        self.assertEqual(len(tools), 3)
        self.assertEqual(len(module), 3)


class NoModule(Case):
    @unittest.skipIf(MODULE, "the Python module is there")
    def test_is_said_if_it_was_asked_for(self):
        cube = self.cube()
        preferences().engine = "MODULE"
        self.refused(
            "shapespace cannot be imported .*: install it for Blender's Python, or choose",
            bpy.ops.shapespace.inbetweens,
        )
        preferences().engine = "AUTOMATIC"
        self.inbetweens(shapes=1)
        self.assertEqual(len(key_names(cube)), 3)
