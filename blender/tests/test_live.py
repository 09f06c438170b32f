"""A mesh that follows its handles while they are dragged, without a window. Skipped where the Python
module cannot be imported."""

import importlib.util
import threading
import time
import unittest
from types import SimpleNamespace

import bpy
import numpy as np
from support import Case, add_key, add_object, assign, key_names, key_shape, preferences, state

MODULE = importlib.util.find_spec("shapespace")


class Refused(Case):
    def test_the_tools_cannot(self):
        cube = add_object("cube", np.eye(3), [[0, 1, 2]])
        assign(cube, "all", np.ones(3, bool))
        bpy.ops.shapespace.handle_add()
        self.refused("the Python module has to compute", bpy.ops.shapespace.deform_live)
        preferences().engine = "AUTOMATIC"
        reason = "needs a window" if MODULE else "cannot be imported"
        self.refused(reason, bpy.ops.shapespace.deform_live)


@unittest.skipIf(MODULE is None, "the Python module is not there: ./dev python builds it")
class Live(Case):
    def setUp(self):
        super().setUp()
        preferences().engine = "MODULE"
        (stand,), faces = self.quadruped("stand")
        self.animal = add_object("animal", stand, faces)
        assign(self.animal, "feet", stand[:, 1] < 0.1)
        bpy.ops.shapespace.handle_add(moves="FIXED")
        assign(self.animal, "head", (stand[:, 1] > 1.2) & (stand[:, 2] > 0.6))
        self.animal.vertex_groups.active_index = 1
        bpy.ops.shapespace.handle_add(moves="EMPTY")
        self.empty = self.animal.shapespace_handles[1].target
        self.threads = threading.active_count()

    def start(self):
        from shapespace_addon.live import Live as Work  # which is installed by now

        settings = SimpleNamespace(
            deform_shapes=5, balance=0.01, stiffness_group="", custom_bending=False,
            custom_volume=False, custom_tolerance=False, loose_components=False, open_seams=False,
        )  # fmt: skip
        live = Work(bpy.context, settings, preferences())
        self.addCleanup(live.stop)
        return live

    def settle(self, live):
        """Steps until the shape for the handles as they are is there."""

        def settled():
            live.step(bpy.context)
            return live.settled

        self.wait_for(settled)

    def test_follows_and_agrees_with_deform(self):
        live = self.start()
        self.settle(live)
        self.assertFalse(live.last.report["warm"])
        for _ in range(3):
            self.empty.location.x += 0.03
            self.settle(live)
            self.assertTrue(live.last.report["warm"])
        warm = key_shape(self.animal, "deformed")
        bpy.ops.shapespace.deform()
        self.near(warm, key_shape(self.animal, "deformed"), 0.01)
        self.assertEqual(key_names(self.animal), ["Basis", "deformed"])

    def test_only_the_latest_place_is_computed(self):
        """Of many that are given while the first is computed."""
        live = self.start()
        given = []
        give = live._solver.give
        live._solver.give = lambda handles: (given.append(handles), give(handles))
        taken = []
        while not (len(given) >= 50 and live.settled):
            if len(given) < 50:
                self.empty.location.x += 0.001
            if live.step(bpy.context):
                taken.append(live.last.handles)
        self.assertLess(len(taken), 25)
        self.assertIs(taken[-1], given[-1])

    def test_what_was_there_comes_back(self):
        before = state()
        live = self.start()
        self.empty.location.x += 0.1
        self.settle(live)
        self.empty.location.x -= 0.1
        self.assertNotEqual(state(), before)
        live.stop()
        live.restore()
        bpy.context.view_layer.update()
        self.assertEqual(self.animal.data.shape_keys, None)
        self.wait_for(lambda: threading.active_count() <= self.threads)

    def test_an_earlier_result_comes_back(self):
        self.empty.location.x += 0.1
        bpy.ops.shapespace.deform()
        self.animal.data.shape_keys.key_blocks["deformed"].value = 0.5
        self.animal.active_shape_key_index = 0
        before = state()
        place = self.empty.location.copy()
        live = self.start()
        self.empty.location.x += 0.3
        self.settle(live)
        live.restore()
        self.empty.location = place
        bpy.context.view_layer.update()
        self.assertEqual(state(), before)
        self.assertEqual(self.animal.active_shape_key_index, 0)

    def test_waits_outside_of_object_mode_and_sees_what_was_done_there(self):
        live = self.start()
        self.settle(live)
        once = key_shape(self.animal, "deformed")
        bpy.ops.object.mode_set(mode="EDIT")
        self.empty.location.x += 0.1
        for _ in range(3):
            live.step(bpy.context)
            time.sleep(0.05)
        self.assertIn("waiting", live.text)
        self.assertFalse(live.restore())
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide()
        bpy.ops.object.mode_set(mode="OBJECT")
        self.settle(live)
        self.assertGreater(len(key_shape(self.animal, "deformed")), 3 * len(once))
        head = assign(self.animal, "head", np.zeros(len(self.animal.data.vertices), bool))
        self.assertEqual(len(head), len(live.last.shape))

    def test_a_key_that_is_gone_is_made_again(self):
        live = self.start()
        self.settle(live)
        self.animal.shape_key_clear()
        self.empty.location.x += 0.1
        self.settle(live)
        self.assertEqual(key_names(self.animal), ["Basis", "deformed"])

    def test_an_older_shape_that_undo_brings_is_replaced(self):
        live = self.start()
        self.empty.location.x += 0.1
        self.settle(live)
        shape = key_shape(self.animal, "deformed")
        key = self.animal.data.shape_keys.key_blocks["deformed"]
        key.data.foreach_set("co", np.zeros(shape.size, "f4"))
        live.write_again()
        self.settle(live)
        self.near(key_shape(self.animal, "deformed"), shape, 1e-3)

    def test_a_mesh_that_is_moved_or_scaled_meanwhile(self):
        live = self.start()
        self.empty.location.x += 0.1
        self.settle(live)
        self.animal.scale = (1, 2, 1)
        self.settle(live)
        live.stop()
        warm = key_shape(self.animal, "deformed")
        bpy.ops.shapespace.deform()
        self.near(warm, key_shape(self.animal, "deformed"), 1e-3)

    def test_ends_with_a_reason(self):
        from shapespace_addon.problem import Problem  # which is installed by now

        for text, change in (
            ("'head' of 'animal' has no target", lambda: bpy.data.objects.remove(self.empty)),
            ("'animal' has no handles", lambda: self.animal.shapespace_handles.clear()),
            ("'animal' is gone", lambda: bpy.data.objects.remove(self.animal)),
        ):
            live = self.start()
            self.settle(live)
            change()
            with self.assertRaisesRegex(Problem, text):
                live.step(bpy.context)
            live.stop()
            if "gone" not in text:
                self.animal.shapespace_handles.clear()
                bpy.ops.shapespace.handle_add(moves="EMPTY")

    def test_a_key_that_cannot_be_seen(self):
        add_key(self.animal, "deformed", [vertex.co for vertex in self.animal.data.vertices])
        self.start().stop()  # a key of that name that is the user's
        bpy.ops.shapespace.deform()
        self.assertEqual(key_names(self.animal), ["Basis", "deformed", "deformed.001"])
        self.animal.data.shape_keys.key_blocks["deformed.001"].mute = True
        self.refused("'deformed.001' is muted or has a driver", bpy.ops.shapespace.deform)
