"""Anchor, ground, stiffness, bending, volume and tolerance of motions."""

import bpy
import numpy as np
from mathutils import Matrix
from support import (
    CUBE,
    CUBE_FACES,
    Case,
    add_object,
    assign,
    bent_cube,
    curves,
    key_names,
    key_shape,
    placed,
    seen,
    select,
)


class Settings(Case):
    def cube(self):
        cube = super().cube()
        self.foot = assign(cube, "foot", np.array(CUBE)[:, 2] < 0)
        return cube

    def slide(self, cube):
        """How far the foot moves, while both poses have it in one place."""
        shapes = [seen(cube, 1 + i)[self.foot] for i in range(5)]
        return max(np.abs(shape.mean(axis=0) - shapes[0].mean(axis=0)).max() for shape in shapes)

    def test_an_anchor_stands_between_poses(self):
        cube = self.cube()
        self.inbetweens(shapes=3)
        free = self.slide(cube)
        self.inbetweens(shapes=3, anchor_group="foot")
        self.assertLess(self.slide(cube), 0.4 * free)
        self.near(seen(cube, 5), bent_cube())

    def test_an_anchor_of_several_objects_with_modifiers(self):
        items = []
        for name, shape in (("a", CUBE), ("b", bent_cube())):
            item = add_object(name, shape, CUBE_FACES)
            self.foot = assign(item, "foot", np.array(CUBE)[:, 2] < 0)
            item.modifiers.new("Subdivision", "SUBSURF").subdivision_type = "SIMPLE"
            items.append(item)
        select(*items)
        self.inbetweens(shapes=3, anchor_group="foot")
        moved = bpy.context.active_object
        self.foot = np.array([vertex.co[2] for vertex in moved.data.vertices]) < -0.9
        self.assertGreater(self.foot.sum(), 0)
        self.assertLess(self.slide(moved), 0.05)

    def test_shapes_stand_on_the_ground_of_the_scene(self):
        cube = self.cube()
        cube.matrix_world = Matrix.Translation((0, 3, 5)) @ Matrix.Rotation(0.7, 4, "X")
        self.inbetweens(shapes=3, ground=True, ground_height=0.5)
        for frame in range(1, 6):
            self.assertAlmostEqual(placed(cube, seen(cube, frame))[:, 2].min(), 0.5, places=5)
        # The poses themselves are as they were, and off.
        self.near(key_shape(cube, "bent"), bent_cube())
        self.assertEqual(len(key_names(cube)), 7)
        self.assertNotIn('key_blocks["bent"].value', curves(cube))
        self.inbetweens(shapes=3)
        self.near(seen(cube, 5), bent_cube())

    def test_the_ground_of_a_cache(self):
        cube = self.cube()
        self.inbetweens(
            shapes=3, ground=True, result="CACHE", cache_folder=str(self.folder)
        )
        for frame in range(1, 6):
            self.assertAlmostEqual(seen(cube, frame)[:, 2].min(), 0, places=5)

    def test_flags_are_those_of_the_tool(self):
        cube = self.cube()
        self.inbetweens(
            shapes=3, custom_bending=True, bending=0.01, custom_volume=True, volume=3,
            custom_tolerance=True, tolerance=1e-9, stiffness_group="foot", stiffness_factor=50,
        )  # fmt: skip
        stiffness = np.where(self.foot, 50.0, 1.0)
        np.savetxt(self.folder / "stiff.txt", stiffness)
        flags = ("--bending", 0.01, "--volume", 3, "--tolerance", 1e-9, "--shapes", 3)
        frames = self.frames(
            [CUBE, bent_cube()], CUBE_FACES, *flags, "--stiffness", self.folder / "stiff.txt"
        )
        plain = self.frames([CUBE, bent_cube()], CUBE_FACES, "--shapes", 3)
        self.assertGreater(np.abs(frames[2] - plain[2]).max(), 1e-3)
        for i, frame in enumerate(frames):
            self.near(seen(cube, 1 + i), frame)

    def test_a_weight_is_a_power_of_the_factor(self):
        cube = self.cube()
        cube.vertex_groups["foot"].add(np.flatnonzero(self.foot).tolist(), 0.5, "REPLACE")
        self.inbetweens(shapes=1, stiffness_group="foot", stiffness_factor=100)
        half = seen(cube, 2)
        assign(cube, "foot", self.foot)
        self.inbetweens(shapes=1, stiffness_group="foot", stiffness_factor=10)
        self.near(seen(cube, 2), half)

    def test_groups_that_are_not_there(self):
        cube = self.cube()
        for setting, text in (("anchor_group", "is to stand"), ("stiffness_group", "is stiffer")):
            self.refused(
                f"'cube' has no vertex group 'leg', which {text}: choose another",
                bpy.ops.shapespace.inbetweens,
                **{setting: "leg"},
            )
        cube.vertex_groups.new(name="nothing")
        self.refused(
            "No vertex of 'cube' has a weight of 0.5 or more in the vertex group 'nothing'",
            bpy.ops.shapespace.extrapolate,
            anchor_group="nothing",
        )

    def test_figures_of_the_report_are_shown(self):
        self.cube()
        self.inbetweens(shapes=3)
        shown = bpy.context.window_manager.shapespace_report
        figures = {figure.name: figure.value for figure in shown.figures}
        self.assertEqual((shown.title, figures["Ended"]), ("In-betweens", "converged"))
        self.assertGreaterEqual(float(figures["Energy / bound"]), 1)
