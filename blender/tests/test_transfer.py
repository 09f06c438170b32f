"""The motion of one body for others."""

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
    read_obj,
    seen,
    select,
    tool,
    write_obj,
)


class Transfer(Case):
    def bodies(self):
        (stand, rear), faces = self.quadruped("stand", "rear")
        (long,), _ = self.quadruped("stand", proportions="long")
        source = add_object("source", stand, faces)
        add_key(source, "rear", rear)
        target = add_object("target", long, faces)
        for name, shape in (("stand", stand), ("rear", rear), ("long", long)):
            write_obj(self.folder / f"{name}.obj", shape, faces)
        return source, target

    def moved(self, *source):
        """What the tool makes of it."""
        tool(
            "shape-transfer", *source, "--target", "long.obj", "--output", "moved/%02d.obj",
            cwd=self.folder,
        )  # fmt: skip
        return [read_obj(file)[0] for file in sorted((self.folder / "moved").iterdir())]

    def test_a_motion_as_the_tools_transfer_it(self):
        source, target = self.bodies()
        tool(
            "shape-interpolate", "stand.obj", "rear.obj", "--shapes", 3, "--output", "a.path",
            cwd=self.folder,
        )  # fmt: skip
        frames = self.moved("a.path")
        before = key_names(source)
        select(target, source)
        self.transfer(shapes=3, frame_step=2)
        self.assertEqual(len(frames), 5)
        for i, frame in enumerate(frames):
            self.near(seen(target, 1 + 2 * i), frame)
        self.assertEqual(key_names(source), before)
        self.assertEqual(key_names(target)[:2], ["Basis", "rear"])

    def test_poses_only_and_in_betweens_afterwards(self):
        source, target = self.bodies()
        frames = self.moved("stand.obj", "rear.obj")
        select(target, source)
        self.transfer(poses_only=True)
        self.assertEqual(key_names(target), ["Basis", "rear"])
        self.near(seen(target, 1), frames[0])
        self.near(seen(target, 2), frames[1])
        select(target)
        self.inbetweens(shapes=1)
        self.assertEqual(key_names(target), ["Basis", "rear", "geo 001"])
        self.near(seen(target, 3), frames[1])

    def test_a_second_run_replaces_the_first(self):
        source, target = self.bodies()
        own = add_key(target, "own", seen(target, 1) * 1.1)
        select(target, source)
        for count in (2, 1):
            self.transfer(shapes=count)
            self.assertEqual(len(key_names(target)), 3 + count)
        self.assertEqual(key_names(target)[:2], ["Basis", "own"])
        self.assertEqual(own.value, 0)

    def test_several_targets_as_caches_each_in_its_place(self):
        cube = self.cube()
        targets = []
        for i in range(2):
            target = add_object(f"target{i}", np.array(CUBE) * (1 + i), CUBE_FACES)
            target.matrix_world = Matrix.Translation((5 * i, 1, 2)) @ Matrix.Rotation(i, 4, "Z")
            targets.append(target)
        select(*targets, cube)
        self.transfer(shapes=1, result="CACHE", cache_folder=str(self.folder))
        self.assertEqual(
            sorted(file.name for file in self.folder.iterdir()), ["target0.pc2", "target1.pc2"]
        )
        for i, target in enumerate(targets):
            self.assertIsNone(target.data.shape_keys)
            self.near(seen(target, 1), np.array(CUBE) * (1 + i))
            # A larger cube, turned, in the bent cube's shape: distances are the source's.
            size = np.linalg.norm(np.subtract(bent_cube()[0], bent_cube()[7]))
            end = placed(target, seen(target, 3))
            self.assertAlmostEqual(np.linalg.norm(end[0] - end[7]) / (1 + i), size, 3)

    def test_what_is_missing(self):
        cube = self.cube()
        self.refused("No target is selected: select bodies", bpy.ops.shapespace.transfer)
        other = add_object("other", CUBE, CUBE_FACES[:5])
        select(other, cube)
        self.refused("'cube' has 6 faces and 'other' 5", bpy.ops.shapespace.transfer)
        twin = bpy.data.objects.new("twin", cube.data)
        bpy.context.scene.collection.objects.link(twin)
        select(twin, cube)
        self.refused("'twin' shares its mesh .*single user", bpy.ops.shapespace.transfer)
        bpy.context.view_layer.objects.active = None
        self.refused("The active object is no mesh", bpy.ops.shapespace.transfer)
        select(cube, other)
        self.refused("'other' has no shape keys", bpy.ops.shapespace.transfer)
