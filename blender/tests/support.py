"""Scenes to test on, and what is in them."""

import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from types import SimpleNamespace

import bpy
import numpy as np

ADDON = "shapespace_addon"
PROJECT = pathlib.Path(__file__).resolve().parents[2]
_BIN = pathlib.Path(os.environ.get("SHAPESPACE_BIN", PROJECT / "build/release/bin"))

# The module as ./dev python installs it, if it was built for this Python.
_PYTHON = f"python{sys.version_info.major}.{sys.version_info.minor}"
sys.path.append(str(PROJECT / f"build/python-venv/lib/{_PYTHON}/site-packages"))


def preferences():
    return bpy.context.preferences.addons[ADDON].preferences


def tool(name, *arguments, cwd):
    program = shutil.which(name, path=str(_BIN))
    if program is None:
        raise FileNotFoundError(f"no {name} in {_BIN}: name the tools' folder in SHAPESPACE_BIN")
    subprocess.run([program, *map(str, arguments)], cwd=cwd, check=True, stdout=subprocess.DEVNULL)


def read_obj(file):
    vertices, faces = [], []
    for line in pathlib.Path(file).read_text().splitlines():
        kind, *rest = line.split()
        if kind == "v":
            vertices.append([float(x) for x in rest[:3]])
        elif kind == "f":
            faces.append([int(corner.split("/")[0]) - 1 for corner in rest])
    return np.array(vertices), faces


def write_obj(file, vertices, faces):
    with open(file, "w") as out:
        for vertex in vertices:
            out.write("v {!r} {!r} {!r}\n".format(*map(float, vertex)))
        for face in faces:
            out.write(f"f {' '.join(str(v + 1) for v in face)}\n")


def add_object(name, vertices, faces, edges=()):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(v) for v in vertices], list(edges), [tuple(f) for f in faces])
    item = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(item)
    select(item)
    return item


def add_key(item, name, vertices):
    if item.data.shape_keys is None:
        item.shape_key_add(name="Basis", from_mix=False)
    key = item.shape_key_add(name=name, from_mix=False)
    key.data.foreach_set("co", np.asarray(vertices, np.float32).reshape(-1))
    return key


def linked_from_file(file, name):
    """Saves the scene, and returns this object of it as one that is linked into an empty scene."""
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(str(file), link=True) as (_, here):
        here.objects = [name]
    item = bpy.data.objects[name]
    bpy.context.scene.collection.objects.link(item)
    return item


def assign(item, name, chosen):
    """Gives a vertex group the chosen vertices, a truth value for each, which are returned."""
    group = item.vertex_groups.get(name) or item.vertex_groups.new(name=name)
    group.add(np.flatnonzero(chosen).tolist(), 1, "REPLACE")
    return np.asarray(chosen)


def select(*items):
    """The last one is active."""
    bpy.context.view_layer.update()  # before which objects that were removed are None in it
    for item in bpy.context.view_layer.objects:
        item.select_set(item in items)
    bpy.context.view_layer.objects.active = items[-1]


def seen(item, frame):
    """The object's vertices as they are shown at a frame, or between two, in its own coordinates."""
    whole = math.floor(frame)
    bpy.context.scene.frame_set(whole, subframe=frame - whole)
    evaluated = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", flat)
    evaluated.to_mesh_clear()
    return flat.reshape(-1, 3).astype(float)


def placed(item, vertices):
    """In coordinates of the scene."""
    matrix = np.array(item.matrix_world)
    return vertices @ matrix[:3, :3].T + matrix[:3, 3]


def key_names(item):
    return [key.name for key in item.data.shape_keys.key_blocks]


def key_shape(item, name):
    flat = np.empty(3 * len(item.data.vertices), np.float32)
    item.data.shape_keys.key_blocks[name].data.foreach_get("co", flat)
    return flat.reshape(-1, 3).astype(float)


def curves(item):
    """The keyframes of shape keys by the names of the curves' properties."""
    from shapespace_addon.animation import curves_of  # which is installed by now

    return {
        curve.data_path: [tuple(point.co) for point in curve.keyframe_points]
        for curve in curves_of(item.data.shape_keys)
    }


def state():
    """Everything in the file that the add-on could have changed."""
    found = {"selected": sorted(item.name for item in bpy.context.selected_objects)}
    for item in bpy.data.objects:
        found[item.name] = [
            [(m.name, m.type) for m in item.modifiers],
            [tuple(row) for row in item.matrix_world],
            item.mode,
        ]
        if item.type == "MESH":
            found[item.name].append([tuple(v.co) for v in item.data.vertices])
            if item.data.shape_keys is not None:
                found[item.name] += [
                    [(k.name, k.value, k.mute) for k in item.data.shape_keys.key_blocks],
                    [key_shape(item, name).tolist() for name in key_names(item)],
                    curves(item),
                    _dict(item.data.shape_keys.get("shapespace")),
                ]
    return found


def _dict(group):
    return None if group is None else group.to_dict()


def temporary_folders():
    """Of runs of the tools."""
    return [name for name in os.listdir(bpy.app.tempdir) if name.startswith("shapespace-")]


def children():
    """Processes that this one has started and that still run."""
    return pathlib.Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()


def stand_in(folder, script):
    """Writes, for each tool, a program of its name that runs a script, in which `$tool` is the tool
    itself."""
    for name in ("shape-interpolate", "shape-extrapolate", "shape-transfer"):
        program = folder / name
        program.write_text(f"#!/bin/sh\ntool='{_BIN / name}'\n{script}\n")
        program.chmod(0o755)


class Case(unittest.TestCase):
    """Begins with an empty scene and the tools, and has a folder for files."""

    def setUp(self):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        preferences().engine = "TOOLS"
        preferences().tools = str(_BIN)
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.folder = pathlib.Path(made.name)

    def tearDown(self):
        self.assertEqual(temporary_folders(), [])

    def cube(self, name="cube"):
        """A cube with a second shape key, 'bent'."""
        cube = add_object(name, CUBE, CUBE_FACES)
        add_key(cube, "bent", bent_cube())
        return cube

    def inbetweens(self, **settings):
        """With shapes that are one frame apart from frame 1 on, if `settings` have no others."""
        return bpy.ops.shapespace.inbetweens(custom_frames=True, **settings)

    def extrapolate(self, **settings):
        return bpy.ops.shapespace.extrapolate(custom_frames=True, **settings)

    def transfer(self, **settings):
        return bpy.ops.shapespace.transfer(custom_frames=True, **settings)

    def begin(self, kind="InBetweens", **changes):
        """The work of an operator, begun as its button does."""
        from shapespace_addon import work  # which is installed by now

        settings = {
            "shapes": 3, "metric": "strain", "use_basis": True, "result": "KEYS",
            "allow_mirrored": False,
            "custom_frames": True, "frame_start": 1, "frame_step": 1,
            "cache_folder": "//", "stiffness_group": "",
            "custom_bending": False, "custom_volume": False, "custom_tolerance": False,
            "anchor_group": "", "ground": False, "loose_components": False, "open_seams": False,
        }  # fmt: skip
        given = SimpleNamespace(**{**settings, **changes})
        return getattr(work, kind)(bpy.context, given, preferences())

    def wait_for(self, condition):
        end = time.monotonic() + 20
        while not condition():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)

    def near(self, a, b, tolerance=1e-5):
        self.assertEqual(np.shape(a), np.shape(b))
        self.assertLessEqual(np.abs(np.asarray(a) - b).max(), tolerance)

    def refused(self, text, call, *arguments, **options):
        """The call ends in an error report with this text, or Blender refuses it with this text as
        the reason. Nothing changes."""
        bpy.context.view_layer.update()
        before = state()
        with self.assertRaisesRegex(RuntimeError, f"(?s)^(Error: |Operator .*poll\\(\\) ).*{text}"):
            call(*arguments, **options)
        self.assertEqual(state(), before)

    def quadruped(self, *poses, triangles=1500, proportions="normal"):
        """Its vertices in each pose, and its faces."""
        tool(
            "shape-body", "quadruped", "--triangles", triangles, "--pose", ",".join(poses),
            "--proportions", proportions, "--output", "pose%d.obj", cwd=self.folder,
        )  # fmt: skip
        read = [read_obj(self.folder / f"pose{i}.obj") for i in range(len(poses))]
        return [np.float32(vertices).astype(float) for vertices, _ in read], read[0][1]

    def frames(self, shapes, faces, *flags, name="shape-interpolate"):
        """What a tool makes of these shapes, as OBJ frames."""
        files = [f"given{i}.obj" for i in range(len(shapes))]
        for file, shape in zip(files, shapes):
            write_obj(self.folder / file, shape, faces)
        out = self.folder / "frames"
        shutil.rmtree(out, ignore_errors=True)
        tool(name, *files, *flags, "--output", "frames/%03d.obj", cwd=self.folder)
        return [read_obj(file)[0] for file in sorted(out.iterdir())]


# Coordinates are exact in single precision. No two diagonals of a face are equally long: which of
# them a face is cut by would depend on how coordinates are rounded.
CUBE = [
    [x + 0.125 * y * z, y + 0.25 * x * z + 0.0625 * z, z + 0.1875 * x * y]
    for x in (-1, 1)
    for y in (-1, 1)
    for z in (-1, 1)
]
CUBE_FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def bent_cube():
    """Its upper half turned by some 53 degrees about the vertical axis."""
    turn = np.array([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]])
    return [np.float32(turn @ v).tolist() if v[2] > 0 else v for v in CUBE]
