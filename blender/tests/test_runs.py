"""What a button's run does step by step: progress, cancelling, and changes of the scene meanwhile.
In background there is no window that would call modal(); these are the calls that it makes."""

import time

import bpy
from shapespace_addon.problem import Problem
from support import (
    CUBE,
    CUBE_FACES,
    Case,
    add_key,
    add_object,
    children,
    preferences,
    select,
    stand_in,
    state,
    temporary_folders,
)


class Runs(Case):
    def stand_in(self, script):
        """Has a script take the place of the tools; `$tool` is the one that was called."""
        stand_in(self.folder, script)
        preferences().tools = str(self.folder)

    def test_progress(self):
        self.cube()
        self.stand_in(
            'echo "progress - reading files" >&2; touch began\n'
            f"while ! [ -e {self.folder}/go ]; do sleep .01; done\n"
            'echo "progress 0.5 solving: 3 of 6" >&2\n'
            f"while ! [ -e {self.folder}/end ]; do sleep .01; done\n"
            'exec $tool "$@"'
        )
        work = self.begin()
        self.wait_for(lambda: work.text == "reading files")
        self.assertIsNone(work.share)
        (self.folder / "go").touch()
        self.wait_for(lambda: work.text == "solving: 3 of 6")
        self.assertEqual(work.share, 0.5)
        self.assertFalse(work.poll())
        (self.folder / "end").touch()
        work.wait()
        self.assertEqual(work.finish(bpy.context), [])

    def test_progress_of_two_tools_in_turn(self):
        target = add_object("target", CUBE, CUBE_FACES)
        select(target, self.cube())
        self.stand_in(
            'name=$(basename $tool); echo "progress 0.5 $name" >&2\n'
            f"while ! [ -e {self.folder}/go-$name ]; do sleep .01; done\n"
            'exec $tool "$@" 2>/dev/null'
        )
        work = self.begin("Transfer", poses_only=False)
        for name, share in (("shape-interpolate", 0.25), ("shape-transfer", 0.75)):
            self.wait_for(lambda: work.poll() or work.text == name)
            self.assertEqual(work.share, share)
            (self.folder / f"go-{name}").touch()
        work.wait()
        work.finish(bpy.context)

    def test_progress_of_the_tools(self):
        """The share never falls, and is told often enough for a bar."""
        (sit, stretch), faces = self.quadruped("sit", "stretch", triangles=20000)
        add_key(add_object("animal", sit, faces), "stretch", stretch)
        work = self.begin(shapes=127)
        shares = []
        while not work.poll():
            if work.share is not None:
                shares.append(work.share)
            time.sleep(0.01)
        work.finish(bpy.context)
        self.assertEqual(shares, sorted(shares))
        self.assertGreater(len(set(shares)), 2)
        self.assertLessEqual(shares[-1], 1)

    def test_cancelling_leaves_nothing(self):
        (sit, stretch), faces = self.quadruped("sit", "stretch", triangles=20000)
        animal = add_object("animal", sit, faces)
        add_key(animal, "stretch", stretch)
        before = state()
        work = self.begin(shapes=63)
        self.assertEqual((len(children()), len(temporary_folders())), (1, 1))
        self.wait_for(lambda: work.share is not None)
        work.cancel()
        self.assertEqual((children(), temporary_folders(), state()), ([], [], before))

    def test_cancelling_lets_a_process_end_by_itself(self):
        self.cube()
        self.stand_in(
            f"trap 'touch {self.folder}/ended; exit' TERM\n"
            "echo 'progress 0 listening' >&2; while :; do sleep .1; done"
        )
        work = self.begin()
        self.wait_for(lambda: work.text == "listening")
        work.cancel()
        self.assertTrue((self.folder / "ended").exists())

    def test_cancelling_a_process_that_does_not_listen(self):
        self.cube()
        self.stand_in("trap '' TERM; echo 'progress 0 deaf' >&2; while :; do sleep .1; done")
        work = self.begin()
        self.wait_for(lambda: work.text == "deaf")
        work.cancel()
        self.assertEqual((children(), temporary_folders()), ([], []))

    def finish_after(self, change):
        """A run during which the scene is changed."""
        work = self.begin()
        work.wait()
        change()
        before = state()
        with self.assertRaises(Problem) as raised:
            work.finish(bpy.context)
        self.assertEqual(state(), before)
        return str(raised.exception)

    def test_the_mesh_is_edited_meanwhile(self):
        cube = self.cube()

        def edit():
            cube.data.shape_keys.key_blocks["bent"].data[0].co.x += 0.1

        self.assertIn("'cube' has changed since the run began", self.finish_after(edit))

    def test_a_vertex_is_added_meanwhile(self):
        self.cube()

        def add():
            bpy.ops.object.mode_set(mode="EDIT")
            bpy.ops.mesh.primitive_cube_add()
            bpy.ops.object.mode_set(mode="OBJECT")

        self.assertIn("has changed since the run began", self.finish_after(add))

    def test_faces_are_turned_meanwhile(self):
        cube = self.cube()
        self.assertIn("has changed since the run began", self.finish_after(cube.data.flip_normals))

    def test_a_key_is_renamed_meanwhile(self):
        key = self.cube().data.shape_keys.key_blocks["bent"]
        self.assertIn("changed", self.finish_after(lambda: setattr(key, "name", "other")))

    def test_the_object_is_deleted_meanwhile(self):
        cube = self.cube()
        self.assertIn(
            "'cube' is gone", self.finish_after(lambda: bpy.data.objects.remove(cube))
        )

    def test_edit_mode_is_entered_meanwhile(self):
        self.cube()
        said = self.finish_after(lambda: bpy.ops.object.mode_set(mode="EDIT"))
        self.assertIn("'cube' is in Edit Mode", said)
        bpy.ops.object.mode_set(mode="OBJECT")

    def test_something_else_is_selected_and_moved_meanwhile(self):
        cube = self.cube()
        work = self.begin()
        work.wait()
        select(add_object("other", CUBE, CUBE_FACES))
        cube.location = (1, 2, 3)
        work.finish(bpy.context)
        self.assertEqual(len(cube.data.shape_keys.key_blocks), 5)
        self.assertEqual(bpy.context.active_object.name, "other")

    def test_what_did_not_converge_is_said_once(self):
        (sit, stretch), faces = self.quadruped("sit", "stretch")
        add_key(add_object("animal", sit, faces), "stretch", stretch)
        self.stand_in('exec $tool --max_iterations 1 "$@"')
        work = self.begin()
        work.wait()
        notes = work.finish(bpy.context)
        self.assertTrue(any("NOT CONVERGED" in note for note in notes), notes)
        self.assertTrue(any("ran out of iterations" in note for note in notes), notes)
        self.assertEqual(len(notes), len(set(notes)))

    def test_keyframes_of_the_user_that_are_replaced_are_named_once(self):
        bent = self.cube().data.shape_keys.key_blocks["bent"]
        bent.keyframe_insert("value", frame=100)
        said = []
        for _ in range(2):
            work = self.begin()
            work.wait()
            said.append(work.finish(bpy.context))
        self.assertEqual(said, [["Keyframes that 'bent' had were replaced"], []])
