"""A mesh that follows its handles while they are dragged."""

import bpy
import numpy as np

from . import engine, handles, shape_keys
from .deforming import DEFORMED, deformation
from .live_solver import LiveSolver
from .poses import matrix_of, pose_of_target
from .problem import Problem


class Live:
    """Begins to compute when it is constructed. `step` is to be called again and again; it and the
    constructor may raise a Problem. Keeps names of data-blocks alone, since they come and go."""

    def __init__(self, context, settings, preferences):
        self._module = engine.module_in_memory(preferences)
        self._settings = settings
        item = handles.mesh_of(context)
        self._name = item.name
        handles.require_some(item)
        shape_keys.require_result_seen(item, DEFORMED)
        self._before = shape_keys.state_before(item, DEFORMED)
        self._solver = None
        self._poses = None
        self.last = None  # the last solution
        self._asked = None  # the places of the handles that were given to the solver
        self._held = None  # the vertices of handles, and the groups for which they were read
        self._changed = True  # whether the mesh and its groups may be others than those last seen
        self.text = ""
        try:
            self.step(context)
        except BaseException:
            self.stop()
            raise

    @property
    def settled(self) -> bool:
        """Whether the shape that is seen is that for the handles as they are."""
        return self._solver is not None and not self._solver.busy and self.last is not None

    def step(self, context) -> bool:
        """Takes a result, and gives the solver the handles if they have moved. Returns whether
        something that is seen has changed."""
        item = bpy.data.objects.get(self._name)
        if item is None or item.name not in context.view_layer.objects:
            raise Problem(f"'{self._name}' is gone, and so is what was deformed")
        if item.mode != "OBJECT":  # in which shape keys must not be written
            self._changed = True
            return self._say(f"waiting, since '{item.name}' is not in Object Mode")
        taken = self._take(item)
        self._follow(context, item)
        return self._say(self._last_in_words()) or taken

    def write_again(self) -> None:
        """To be called after undo and redo, which may have brought an older shape."""
        self._asked = None
        self._changed = True

    def restore(self) -> bool:
        """Makes shape keys what they were before. Returns False if they cannot be written."""
        item = bpy.data.objects.get(self._name)
        if item is None:
            return True
        if item.mode != "OBJECT":
            return False
        shape_keys.restore(item, DEFORMED, self._before)
        return True

    def stop(self) -> None:
        if self._solver is not None:
            self._solver.stop()

    def _take(self, item) -> bool:
        """Shows the solver's result, if there is one."""
        solved = self._solver.take() if self._solver is not None else None
        if solved is None or len(solved.shape) != len(item.data.vertices):
            return False
        shape_keys.require_result_seen(item, DEFORMED)
        shape_keys.show_result(item, DEFORMED, self._poses.frame.to_object(solved.shape))
        self.last = solved
        return True

    def _last_in_words(self) -> str:
        if self.last is None:
            return ""
        return f"{self.last.seconds:.2f} s ({'warm' if self.last.report['warm'] else 'cold'})"

    def _follow(self, context, item) -> None:
        """Gives the solver the handles if they have moved."""
        if (
            self._changed
            or self._poses is None
            or not np.array_equal(matrix_of(context, item), self._poses.frame.matrix)
        ):
            self._look_at_mesh(context, item)
        wanted = handles.read(context, item, self._members(item), self._poses)
        asked = [_place(handle) for handle in wanted]
        if asked != self._asked:
            self._look_at_mesh(context, item)
            self._asked = asked
            self._solver.give(wanted)

    def _look_at_mesh(self, context, item) -> None:
        """Makes a solver for the mesh as it is now, unless there is one."""
        poses = pose_of_target(context, item)
        known = self._poses
        if (
            known is not None
            and poses.same(known)
            and np.array_equal(poses.frame.matrix, known.frame.matrix)
        ):
            return
        task = deformation(context, item, poses, self._settings)
        self.stop()
        self._solver = LiveSolver(self._module, task)
        self._poses = poses
        self._held = None
        self._asked = None

    def _members(self, item) -> list:
        """The vertices of each handle, which take time to read."""
        groups = [handle.vertex_group for handle in handles.of(item)]
        if self._changed or self._held is None or self._held[0] != groups:
            self._held = groups, handles.members(item)
            self._changed = False
        return self._held[1]

    def _say(self, text: str) -> bool:
        """Returns whether this is something new."""
        changed = text != self.text
        self.text = text
        return changed


def _place(handle) -> tuple:
    """What makes a handle another one for the solver, so that it can be compared."""
    motion = handle.motion
    moved = () if motion is None else tuple(np.hstack([*vars(motion).values()]).tolist())
    return handle.vertices.tobytes(), moved, handle.weight
