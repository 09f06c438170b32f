"""Files of the tools, opened with what Blender itself has for them."""

import bpy
import numpy as np
from support import (
    CUBE,
    CUBE_FACES,
    Case,
    add_key,
    add_object,
    bent_cube,
    placed,
    read_obj,
    seen,
    tool,
)

FRAMES = 9


class Files(Case):
    def walk(self):
        """walk.path, of nine shapes, and its vertices as OBJ frames have them."""
        (sit, stretch), faces = self.quadruped("sit", "stretch")
        frames = self.frames([sit, stretch], faces, "--shapes", FRAMES - 2)
        self.export("shape-interpolate", "given0.obj", "given1.obj", "--shapes", FRAMES - 2,
                    "--output", "walk.path")  # fmt: skip
        return frames, faces

    def export(self, *command):
        tool(*command, cwd=self.folder)

    def test_glb_plays_the_frames(self):
        if not hasattr(np, "bool"):
            # Blender 3.4's importer has this name, which NumPy 1.24 has dropped.
            np.bool = bool
            self.addCleanup(delattr, np, "bool")
        frames, _ = self.walk()
        self.export("shape-export", "walk.path", "--once", "--fps", 24, "--output", "walk.glb")
        bpy.ops.import_scene.gltf(filepath=str(self.folder / "walk.glb"))
        (animal,) = [item for item in bpy.data.objects if item.type == "MESH"]
        keys = animal.data.shape_keys
        moving = keys.animation_data
        action = moving.action or moving.nla_tracks[0].strips[0].action
        first = round(action.frame_range[0])
        for i, frame in enumerate(frames):
            # Blender turns glTF's y, which points up, to its own z.
            upright = np.stack([frame[:, 0], -frame[:, 2], frame[:, 1]], axis=1)
            self.near(placed(animal, seen(animal, first + i)), upright)

    def test_point_caches_move_an_imported_obj(self):
        frames, _ = self.walk()
        self.export("shape-export", "walk.path", "--output", "walk.pc2,walk.mdd")
        bpy.ops.wm.obj_import(filepath=str(self.folder / "frames/000.obj"))
        (animal,) = bpy.context.selected_objects
        for kind in ("PC2", "MDD"):
            cache = animal.modifiers.new("cache", "MESH_CACHE")
            cache.cache_format = kind
            cache.filepath = str(self.folder / f"walk.{kind.lower()}")
            cache.frame_start = 1
            for i, frame in enumerate(frames):
                self.near(seen(animal, 1 + i), frame)
            if kind == "MDD":  # which has times too, at 24 frames a second
                cache.play_mode = "CUSTOM"
                cache.time_mode = "TIME"
                cache.eval_time = 2.5 / 24
                self.near(seen(animal, 1), (frames[2] + frames[3]) / 2)
            animal.modifiers.remove(cache)

    def test_shape_keys_in_glb_are_poses(self):
        """Blender splits vertices where normals differ, and the tools put them together."""
        cube = add_object("cube", CUBE, CUBE_FACES)
        add_key(cube, "bent.001", bent_cube())
        cube.location = (3, 2, 1)
        bpy.ops.export_scene.gltf(filepath=str(self.folder / "cube.glb"))
        self.export("shape-interpolate", "cube.glb", "--shapes", 1, "--output", "frames/%d.obj")
        for i, shape in ((0, CUBE), (2, bent_cube())):
            vertices, faces = read_obj(self.folder / f"frames/{i}.obj")
            self.assertEqual((len(vertices), len(faces)), (8, 12))
            upright = np.stack([vertices[:, 0], -vertices[:, 2], vertices[:, 1]], axis=1)
            wanted = np.array(shape) + (3, 2, 1)
            apart = np.linalg.norm(upright[:, None] - wanted[None], axis=2)
            self.assertLess(apart.min(axis=0).max(), 1e-5)
