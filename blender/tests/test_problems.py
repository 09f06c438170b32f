"""Everything that can be expected to go wrong is a report, and changes nothing."""

import os
import pathlib
from unittest import mock

import bpy
import numpy as np
from support import (
    CUBE,
    CUBE_FACES,
    Case,
    add_key,
    add_object,
    bent_cube,
    linked_from_file,
    preferences,
    seen,
    select,
)


class Problems(Case):
    def all_refused(self, text):
        for operator in (bpy.ops.shapespace.inbetweens, bpy.ops.shapespace.extrapolate):
            self.refused(text, operator)

    def test_nothing_to_work_on(self):
        self.all_refused("No mesh is selected: select one with shape keys")
        light = bpy.data.objects.new("light", bpy.data.lights.new("light", "POINT"))
        bpy.context.scene.collection.objects.link(light)
        select(light)
        self.all_refused("No mesh is selected")

    def test_one_pose(self):
        cube = add_object("cube", CUBE, CUBE_FACES)
        self.all_refused("'cube' has no shape keys: add one for each pose, or select several")
        key = add_key(cube, "bent", bent_cube())
        key.mute = True
        self.all_refused("'cube' has one pose only, 'Basis': add shape keys, or unmute")
        self.refused("'cube' has no pose", bpy.ops.shapespace.inbetweens, use_basis=False)

    def test_no_vertices(self):
        for name in ("nothing", "more of it"):
            nothing = add_object(name, [], [])
            nothing.shape_key_add(name="Basis")
            nothing.shape_key_add(name="other")
        self.all_refused("'more of it' has no vertices")
        select(nothing, bpy.data.objects["nothing"])
        self.all_refused("'more of it' has no vertices")
        select(nothing, self.cube())
        self.refused("'more of it' has no vertices", bpy.ops.shapespace.transfer)

    def test_absolute_keys(self):
        self.cube().data.shape_keys.use_relative = False
        self.all_refused("'cube' are absolute: tick Relative")

    def test_edit_mode(self):
        self.cube()
        for mode, name in (("EDIT", "Edit"), ("WEIGHT_PAINT", "Weight Paint")):
            bpy.ops.object.mode_set(mode=mode)
            self.all_refused(f"'cube' is in {name} Mode: change to Object Mode")
            bpy.ops.object.mode_set(mode="OBJECT")

    def test_a_vertex_that_is_nowhere(self):
        self.cube().data.shape_keys.key_blocks["bent"].data[5].co.y = float("nan")
        with self.assertRaisesRegex(RuntimeError, "Vertex 5 of 'bent' is at no finite place"):
            self.inbetweens()

    def test_an_object_without_extent(self):
        self.cube().scale = (1, 0, 1)
        self.all_refused("'cube' is scaled to zero along some direction")

    def test_a_value_that_cannot_be_one(self):
        self.cube().data.shape_keys.key_blocks["bent"].slider_max = 0.5
        self.all_refused("'bent' cannot be 0 and 1: change Range Min and Range Max")

    def test_linked_data(self):
        self.cube()
        cube = linked_from_file(self.folder / "library.blend", "cube")
        select(cube)
        self.all_refused("'cube'")
        self.refused(
            "'cube'",
            bpy.ops.shapespace.inbetweens,
            result="CACHE",
            cache_folder=str(self.folder),
        )
        # An object of this file with the linked mesh may have a cache, but no shape keys.
        own = bpy.data.objects.new("own", cube.data)
        bpy.context.scene.collection.objects.link(own)
        select(own)
        self.all_refused("'own'")
        self.inbetweens(
            shapes=1, result="CACHE", cache_folder=str(self.folder)
        )
        self.near(seen(own, 3), bent_cube())

    def test_tools_that_are_not_there(self):
        self.cube()
        preferences().tools = str(self.folder)
        self.all_refused(f"shape-interpolate was not found in {self.folder}: build shapespace, and")
        path = os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", path)
        os.environ["PATH"] = str(self.folder)
        preferences().tools = ""
        self.all_refused("shape-interpolate was not found in any folder of PATH")

    def test_tools_in_path(self):
        cube = self.cube()
        path = os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", path)
        os.environ["PATH"] = preferences().tools + os.pathsep + path
        preferences().tools = ""
        self.inbetweens(shapes=1)
        self.near(seen(cube, 3), bent_cube())

    def test_tools_of_windows_in_a_folder_of_any_name(self):
        """Programs are named .exe there, but not in what they say."""
        folder = self.folder / "\u043c\u043e\u0438 tools"
        folder.mkdir()

        def which(name, path=None):
            program = folder / f"{name}.exe"
            program.write_text(f'#!/bin/sh\nexec \'{tools}/{name}\' "$@"\n')
            program.chmod(0o755)
            return str(program)

        tools = preferences().tools
        preferences().tools = str(folder)
        cube = add_object("cube", CUBE, CUBE_FACES)
        add_key(cube, "inside out", np.array(CUBE) * [-1, 1, 1])
        with mock.patch("shutil.which", which):
            self.refused(
                "shape-interpolate: 'inside out' against 'Basis': ", bpy.ops.shapespace.inbetweens
            )

    def stand_in(self, script):
        """Has programs with this text take the place of the tools."""
        for name in ("shape-interpolate", "shape-extrapolate", "shape-transfer"):
            program = pathlib.Path(self.folder / name)
            program.write_text(script)
            program.chmod(0o755)
        preferences().tools = str(self.folder)

    def test_programs_that_do_not_run(self):
        self.cube()
        self.stand_in("#!/nowhere/interpreter\n")
        self.all_refused("shape-interpolate cannot be run: No such file|shape-extrapolate cannot")

    def test_a_tool_that_crashes(self):
        self.cube()
        self.stand_in("#!/bin/sh\nkill -SEGV $$\n")
        self.refused("shape-interpolate: ended with code -11", bpy.ops.shapespace.inbetweens)

    def test_a_tool_that_does_not_know_a_flag(self):
        self.cube()
        said = "ERROR: unknown command line flag 'progress'"
        self.stand_in(f'#!/bin/sh\necho "{said}" >&2\nexit 2\n')
        self.refused("unknown command line flag 'progress'", bpy.ops.shapespace.inbetweens)

    def test_the_tools_own_words_name_poses_as_blender_does(self):
        """A body that is inside out in its second pose, which the tool finds."""
        cube = add_object("cube", CUBE, CUBE_FACES)
        add_key(cube, "inside out", np.array(CUBE) * [-1, 1, 1])
        self.refused(
            "shape-interpolate: 'inside out' against 'Basis': ", bpy.ops.shapespace.inbetweens
        )

    def test_three_faces_at_an_edge_are_no_problem(self):
        fin = add_object("fin", [*CUBE, [0, 0, 3]], [*CUBE_FACES, [1, 3, 8]])
        add_key(fin, "bent", [*bent_cube(), [0, 0, 3]])
        self.inbetweens(shapes=1)
        self.near(seen(fin, 3)[:8], bent_cube())
