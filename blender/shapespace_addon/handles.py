"""Handles of an object: vertex groups, each of which stays or follows another object."""

import bpy
import numpy as np
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    PointerProperty,
    StringProperty,
)

from . import rigid_motion, task, vertex_groups
from .poses import Poses, active_mesh, matrix_of, require_object_mode
from .problem import Problem

# The properties of an object that hold its handles, and which of them is active in the list.
HANDLES = "shapespace_handles"
ACTIVE = "shapespace_active_handle"

# By how much, relatively, the scale of a handle's target may differ from that at rest.
_SAME_SCALE = 1e-4


class SHAPESPACE_handle(bpy.types.PropertyGroup):
    """One handle. A target moves it from where the target was when it was chosen."""

    vertex_group: StringProperty(
        name="Vertex Group",
        description="The vertices that are held: those with a weight of 0.5 or more",
    )
    moves: EnumProperty(
        name="Motion",
        description="Where the vertices go",
        items=[
            ("FIXED", "Fixed", "They stay where they are"),
            ("TARGET", "Target", "They move and turn as an object does, such as an empty"),
        ],
    )
    target: PointerProperty(
        name="Target",
        description="The object that the vertices follow, mostly an empty. They follow its motion"
        " from where it was when it was chosen here",
        type=bpy.types.Object,
        poll=lambda handle, item: item != handle.id_data,
        update=lambda handle, context: handle.set_rest(context),
    )
    soft: BoolProperty(
        name="Soft",
        description="The vertices yield where the surface resists, and need not reach their places",
    )
    weight: FloatProperty(
        name="Weight",
        description="How strongly a soft handle pulls, relative to other soft handles",
        default=1,
        min=1e-6,
        soft_max=100,
    )
    rest: FloatVectorProperty(
        name="Rest",
        description="The target's matrix, in coordinates of the mesh, with which nothing has moved",
        size=16,
        default=[0.0] * 16,
        options={"HIDDEN"},
    )
    rest_scale: FloatVectorProperty(
        name="Scale at Rest",
        description="The target's own scale at rest",
        options={"HIDDEN"},
    )

    def set_rest(self, context) -> None:
        """Makes the target's present place the one from which it moves the handle."""
        if self.target is None:
            return
        try:
            body = matrix_of(context, self.id_data)
            target = matrix_of(context, self.target)
        except Problem:  # which is said when the handle is used
            self.rest = [0.0] * 16
            return
        self.rest = np.linalg.solve(body, target).reshape(-1)
        self.rest_scale = self.target.scale


def of(item):
    return getattr(item, HANDLES)


def mesh_of(context):
    """The active mesh, or the mesh of which the active object, such as an empty, moves a handle.
    Raises a Problem unless there is one, in Object Mode."""
    active = context.active_object
    if active is not None and active.type != "MESH":
        for item in filter(None, context.view_layer.objects):  # None: removed a moment ago
            if item.type == "MESH" and any(handle.target == active for handle in of(item)):
                require_object_mode(item)
                return item
    return active_mesh(context)


def require_some(item) -> None:
    if not of(item):
        raise Problem(
            f"'{item.name}' has no handles: add one for a vertex group, in the tab shapespace of the"
            " sidebar of the 3D view"
        )


def members(item) -> list:
    """The vertices of each handle. Raises a Problem if there are none."""
    require_some(item)
    for number, handle in enumerate(of(item), 1):
        if not handle.vertex_group:
            raise Problem(f"Handle {number} of '{item.name}' has no vertex group: choose one")
    return [
        vertex_groups.members(item, handle.vertex_group, item.data.vertices, "is a handle")
        for handle in of(item)
    ]


def read(context, item, held: list, poses: Poses) -> list:
    """The handles as engines take them: `held` are their vertices, and coordinates those of the
    poses' frame."""
    return [
        task.Handle(
            handle.vertex_group,
            vertices,
            _motion(context, item, handle, poses) if handle.moves == "TARGET" else None,
            handle.weight if handle.soft else None,
        )
        for handle, vertices in zip(of(item), held)
    ]


def _motion(context, item, handle, poses: Poses) -> task.Motion:
    target = handle.target
    name = f"The handle '{handle.vertex_group}' of '{item.name}'"
    if target is None:
        raise Problem(f"{name} has no target: choose an empty for it, or let it be fixed")
    if target == item:
        raise Problem(f"{name} has the mesh itself as its target: choose another object")
    if target.name not in context.view_layer.objects:
        raise Problem(
            f"The target '{target.name}' of a handle of '{item.name}' is not in this scene, perhaps"
            " because it was deleted: choose another one"
        )
    now = matrix_of(context, target)
    own = np.array(handle.rest).reshape(4, 4)
    if not own.any():
        raise Problem(f"{name} has no place to start from: press Set Rest")
    if not np.allclose(target.scale, handle.rest_scale, _SAME_SCALE, _SAME_SCALE):
        raise Problem(
            f"'{target.name}' was scaled, but handles only move and turn: clear its scale, or press"
            " Set Rest to go on from here"
        )
    motion = rigid_motion.between(poses.frame.matrix @ own, now, poses.frame.centre)
    if motion is None:
        raise Problem(
            f"'{target.name}' or '{item.name}' was mirrored since the handle was made: give both"
            " a positive scale, or press Set Rest to go on from here"
        )
    return motion
