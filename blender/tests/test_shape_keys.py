"""In-betweens of shape keys, as shape keys."""

import math

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
    curves,
    key_names,
    key_shape,
    placed,
    seen,
)


class ShapeKeys(Case):
    def test_quadruped_moves_as_the_frames_of_the_tool(self):
        (sit, stretch), faces = self.quadruped("sit", "stretch")
        animal = add_object("animal", sit, faces)
        add_key(animal, "stretch", stretch)
        self.inbetweens(shapes=7, frame_start=10, frame_step=3)
        frames = self.frames([sit, stretch], faces, "--shapes", 7)
        self.assertEqual(len(frames), 9)
        for i, frame in enumerate(frames):
            self.near(seen(animal, 10 + 3 * i), frame)
        # Linear between shapes, and at rest before and after the motion.
        self.near(seen(animal, 14), (2 * frames[1] + frames[2]) / 3)
        self.near(seen(animal, 1), sit)
        self.near(seen(animal, 90), stretch)

    def test_three_poses_of_a_cube_of_quadrilaterals(self):
        wide = np.array(CUBE) * [2, 1, 1]
        cube = self.cube()
        add_key(cube, "wide", wide)
        self.inbetweens(shapes=3)
        frames = self.frames([CUBE, bent_cube(), wide], CUBE_FACES, "--shapes", 3)
        self.assertEqual(len(frames), 9)
        for i, frame in enumerate(frames):
            self.near(seen(cube, 1 + i), frame)
        self.near(seen(cube, 5), bent_cube())

    def test_polygons_with_many_corners_and_of_different_numbers(self):
        corners = 300  # more than fit into a byte
        angles = (np.arange(corners) + 0.3 * np.sin(np.arange(corners))) * 2 * np.pi / corners
        ring = [[math.cos(a), 1.2 * math.sin(a), 0.0] for a in angles]
        vertices = np.float32(ring + [[x, y, 1 + 0.1 * x] for x, y, _ in ring] + [[0, 0, 2]])
        faces = [list(range(corners))[::-1]]
        for i in range(corners):
            j = (i + 1) % corners
            faces += [[i, j, corners + j, corners + i], [corners + i, corners + j, 2 * corners]]
        tall = vertices * [1, 1, 1.5]
        drum = add_object("drum", vertices, faces)
        add_key(drum, "tall", tall)
        self.inbetweens(shapes=1)
        frames = self.frames([vertices, tall], faces, "--shapes", 1)
        self.near(seen(drum, 2), frames[1])

    def test_a_rope_of_edges(self):
        along = np.linspace(0, 3, 12)
        straight = np.stack([along, 0 * along, 0 * along], axis=1)
        curled = np.stack([np.sin(along), 1 - np.cos(along), 0 * along], axis=1)
        rope = add_object("rope", straight, [], [(i, i + 1) for i in range(11)])
        add_key(rope, "curled", curled)
        self.inbetweens(shapes=1)
        lengths = np.linalg.norm(np.diff(seen(rope, 2), axis=0), axis=1)
        self.near(lengths, np.full(11, 3 / 11), 1e-3)

    def test_what_is_computed_is_what_is_seen(self):
        """An object that is moved, turned and scaled, more along one axis than along another."""
        cube = self.cube()
        cube.matrix_world = (
            Matrix.Translation((3, -2, 5))
            @ Matrix.Rotation(0.7, 4, "X")
            @ Matrix.Diagonal((1, 1, 3, 1))
        )
        bpy.context.view_layer.update()
        scene = [placed(cube, np.array(shape)) for shape in (CUBE, bent_cube())]
        self.inbetweens(shapes=3)
        frames = self.frames(scene, CUBE_FACES, "--shapes", 3)
        for i, frame in enumerate(frames):
            self.near(placed(cube, seen(cube, 1 + i)), frame)

    def test_far_from_the_origin(self):
        (sit, stretch), faces = self.quadruped("sit", "stretch")
        near = add_object("near", sit, faces)
        add_key(near, "stretch", stretch)
        self.inbetweens(shapes=3)
        far = add_object("far", sit, faces)
        add_key(far, "stretch", stretch)
        far.location = (1e6, -1e6, 1e6)
        self.inbetweens(shapes=3)
        self.near(seen(far, 3), seen(near, 3))

    def test_keys_of_the_user_stay_as_they_are(self):
        cube = add_object("cube", CUBE, CUBE_FACES)
        bent = add_key(cube, "bent", bent_cube())
        muted = add_key(cube, "geo 001", np.array(CUBE) * 1.5)
        muted.mute = True
        muted.value = 0.25
        shapes = {name: key_shape(cube, name) for name in key_names(cube)}
        for count in (3, 2):
            self.inbetweens(shapes=count)
            self.assertEqual(key_names(cube)[:3], ["Basis", "bent", "geo 001"])
            self.assertEqual(len(key_names(cube)), 3 + count)
            for name, shape in shapes.items():
                self.near(key_shape(cube, name), shape, 0)
            self.assertEqual(muted.value, 0.25)
            self.assertEqual((bent.relative_key.name, bent.mute), ("Basis", False))

    def test_a_second_run_replaces_the_first(self):
        cube = self.cube()
        self.inbetweens(shapes=5, frame_start=1, frame_step=10)
        self.inbetweens(shapes=2, frame_start=20)
        again = key_names(cube), curves(cube)
        fresh = add_object("fresh", CUBE, CUBE_FACES)
        add_key(fresh, "bent", bent_cube())
        self.inbetweens(shapes=2, frame_start=20)
        self.assertEqual(again, (key_names(fresh), curves(fresh)))

    def test_a_key_that_was_renamed_is_the_users(self):
        cube = self.cube()
        self.inbetweens(shapes=1)
        key = cube.data.shape_keys.key_blocks["geo 001"]
        key.name = "half"
        half = key_shape(cube, "half")
        self.inbetweens(shapes=1)
        self.near(key_shape(cube, "half"), half, 0)
        self.assertEqual(len(key_names(cube)), 5)  # three poses, one shape in each of two gaps

    def test_only_one_key_is_on_at_its_frame(self):
        cube = self.cube()
        self.inbetweens(shapes=4, frame_step=2)
        for i in range(6):
            bpy.context.scene.frame_set(1 + 2 * i)
            on = [k.value for k in cube.data.shape_keys.key_blocks][1:]
            self.assertEqual(sorted(on), [0, 0, 0, 0, 0 if i == 0 else 1])

    def test_the_shape_of_the_present_frame_is_shown_at_once(self):
        cube = self.cube()
        bpy.context.scene.frame_set(3)
        self.inbetweens(shapes=3)
        values = [key.value for key in cube.data.shape_keys.key_blocks]
        bpy.context.scene.frame_set(3)
        self.assertEqual(values, [key.value for key in cube.data.shape_keys.key_blocks])
        self.assertIn(1, values)

    def test_the_motion_is_seen_though_one_key_was_pinned(self):
        cube = self.cube()
        cube.show_only_shape_key = True
        self.inbetweens(shapes=1)
        self.near(seen(cube, 1), CUBE)
        self.near(seen(cube, 3), bent_cube())

    def test_poses_are_what_a_key_shows_alone(self):
        """Keys relative to another key, and keys with a vertex group."""
        cube = add_object("cube", CUBE, CUBE_FACES)
        wide = add_key(cube, "wide", np.array(CUBE) * [2, 1, 1])
        both = add_key(cube, "both", np.array(CUBE) * [2, 1, 2])
        both.relative_key = wide
        group = cube.vertex_groups.new(name="half")
        group.add([4, 5, 6, 7], 0.5, "REPLACE")
        wide.vertex_group = "half"
        shown = []
        for key in (wide, both):
            key.value = 1
            shown.append(seen(cube, 1))
            key.value = 0
        self.near(shown[1], np.array(CUBE) * [1, 1, 2], 0)
        self.near(shown[0][4], np.array(CUBE[4]) * [1.5, 1, 1], 0)
        self.inbetweens(shapes=1)
        self.near(seen(cube, 3), shown[0])
        frames = self.frames([CUBE, *shown], CUBE_FACES, "--shapes", 1)
        for i, frame in enumerate(frames):
            self.near(seen(cube, 1 + i), frame)

    def test_the_basis_can_be_left_out(self):
        cube = add_object("cube", CUBE, CUBE_FACES)
        wide = np.array(CUBE) * [2, 1, 1]
        add_key(cube, "bent", bent_cube())
        add_key(cube, "wide", wide)
        self.inbetweens(shapes=1, use_basis=False)
        frames = self.frames([bent_cube(), wide], CUBE_FACES, "--shapes", 1)
        for i, frame in enumerate(frames):
            self.near(seen(cube, 1 + i), frame)
        self.near(seen(cube, -5), bent_cube())

    def walk(self, **settings):
        """Stand, sit and stretch with in-betweens, the poses, and what is seen at each frame."""
        poses, faces = self.quadruped("stand", "sit", "stretch")
        animal = add_object("animal", poses[0], faces)
        for name, pose in zip(("sit", "stretch"), poses[1:]):
            add_key(animal, name, pose)
        self.inbetweens(shapes=7, **settings)
        last = 24 if settings.get("cyclic") else 16
        return poses, [seen(animal, 1 + i) for i in range(last + 1)]

    def jump(self, frames, before, after):
        """The jump of velocity between two frames that show one pose, over the mean speed."""
        arriving = 3 * frames[before] - 4 * frames[before - 1] + frames[before - 2]
        leaving = 4 * frames[after + 1] - 3 * frames[after] - frames[after + 2]
        way = sum(np.linalg.norm(b - a) for a, b in zip(frames, frames[1:]))
        return np.linalg.norm(leaving - arriving) / 2 / (way / (len(frames) - 1))

    def test_smooth_motion_does_not_jump_at_the_poses(self):
        _, frames = self.walk()
        self.assertGreater(self.jump(frames, 8, 8), 0.5)
        poses, frames = self.walk(smooth=True)
        self.assertLess(self.jump(frames, 8, 8), 0.2)
        for i, pose in enumerate(poses):
            self.near(frames[8 * i], pose)

    def test_cyclic_motion_ends_as_it_begins(self):
        poses, frames = self.walk(smooth=True, cyclic=True)
        self.near(frames[24], poses[0])
        for end in ((8, 8), (16, 16), (24, 0)):
            self.assertLess(self.jump(frames, *end), 0.3)

    def test_cyclic_motion_may_begin_with_a_key(self):
        poses, faces = self.quadruped("stand", "sit", "stretch")
        animal = add_object("animal", poses[1], faces)
        for name, pose in zip(("a", "b", "c"), poses):
            add_key(animal, name, pose)
        self.inbetweens(shapes=3, use_basis=False, smooth=True, cyclic=True)
        for frame, pose in ((1, 0), (5, 1), (9, 2), (13, 0)):
            self.near(seen(animal, frame), poses[pose])
        self.assertGreater(np.abs(seen(animal, 7) - poses[0]).max(), 0.01)

    def test_cyclic_motion_repeats_as_a_strip(self):
        cube = self.cube()
        add_key(cube, "wide", np.array(CUBE) * [2, 1, 1])
        for use_basis in (True, False):
            self.inbetweens(
                shapes=3, frame_step=2, use_basis=use_basis, smooth=True, cyclic=True
            )
            period = 2 * 4 * (3 if use_basis else 2)
            once = [seen(cube, 1 + i) for i in range(period)]
            animation = cube.data.shape_keys.animation_data
            action = animation.action
            track = animation.nla_tracks.new()
            track.strips.new("strip", 1, action).repeat = 2
            animation.action = None
            for i in range(2 * period):
                self.near(seen(cube, 1 + i), once[i % period])
            animation.nla_tracks.remove(track)
            animation.action = action

    def test_cyclic_motion_that_already_returns(self):
        cube = self.cube()
        add_key(cube, "again", CUBE)
        self.refused(
            "the last pose is the first: leave it out",
            bpy.ops.shapespace.inbetweens,
            smooth=True,
            cyclic=True,
        )

    def test_smooth_motion_through_two_poses_is_the_geodesic_and_says_so(self):
        cube = self.cube()
        work = self.begin(smooth=True, cyclic=False)
        work.wait()
        (note,) = work.finish(bpy.context)
        self.assertIn("only two poses", note)
        for i, frame in enumerate(self.frames([CUBE, bent_cube()], CUBE_FACES, "--shapes", 3)):
            self.near(seen(cube, 1 + i), frame)
        self.inbetweens(shapes=3, smooth=True, cyclic=True)
        for frame, shape in ((1, CUBE), (5, bent_cube()), (9, CUBE)):
            self.near(seen(cube, frame), shape)

    def test_extrapolation_goes_on_as_the_tool_does(self):
        (stand, rear), faces = self.quadruped("stand", "rear")
        animal = add_object("animal", stand, faces)
        add_key(animal, "rear", rear)
        self.extrapolate(shapes=3, steps=3)
        frames = self.frames(
            [stand, rear], faces, "--shapes", 3, "--steps", 3, name="shape-extrapolate"
        )
        self.assertEqual(len(frames), 8)
        for i, frame in enumerate(frames):
            self.near(seen(animal, 1 + i), frame)

    def driven_cube(self, expression):
        """A cube whose pose `bent` has a driver, and another pose."""
        cube = add_object("cube", CUBE, CUBE_FACES)
        bent = add_key(cube, "bent", bent_cube())
        add_key(cube, "wide", np.array(CUBE) * [2, 1, 1])
        bent.driver_add("value").driver.expression = expression
        return cube

    def frames_of_driven_cube(self):
        poses = [CUBE, bent_cube(), np.array(CUBE) * [2, 1, 1]]
        return self.frames(poses, CUBE_FACES, "--shapes", 1)

    def test_a_key_with_a_driver_is_a_pose_and_keeps_its_driver(self):
        cube = self.driven_cube("0")
        for _ in range(2):
            work = self.begin(shapes=1)
            work.wait()
            (note,) = work.finish(bpy.context)
            self.assertIn("'bent'", note)
            self.assertNotIn("'wide'", note)
            for i, frame in enumerate(self.frames_of_driven_cube()):
                self.near(seen(cube, 1 + i), frame)
            self.assertEqual(len(cube.data.shape_keys.animation_data.drivers), 1)
            self.assertNotIn('key_blocks["bent"].value', curves(cube))
            self.assertEqual(len(key_names(cube)), 6)

    def test_where_a_driver_turns_its_key_on_it_is_added(self):
        cube = self.driven_cube("0.5")
        self.inbetweens(shapes=1)
        for i, frame in enumerate(self.frames_of_driven_cube()):
            self.near(seen(cube, 1 + i), frame + (np.array(bent_cube()) - CUBE) / 2)

    def test_on_the_ground_a_key_with_a_driver_keeps_it_too(self):
        cube = self.driven_cube("0")
        self.inbetweens(shapes=1, ground=True)
        for i in range(5):
            self.assertAlmostEqual(seen(cube, 1 + i)[:, 2].min(), 0, places=5)
        self.assertNotIn('key_blocks["bent"].value', curves(cube))

    def test_the_metric_is_the_chosen_one(self):
        cube = self.cube()
        self.inbetweens(shapes=3, metric="rigid")
        frames = self.frames([CUBE, bent_cube()], CUBE_FACES, "--shapes", 3, "--metric", "rigid")
        plain = self.frames([CUBE, bent_cube()], CUBE_FACES, "--shapes", 3)
        self.assertGreater(np.abs(frames[2] - plain[2]).max(), 1e-3)
        self.near(seen(cube, 3), frames[2])
