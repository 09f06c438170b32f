"""Operators that make and change the handles of the active mesh."""

import bpy
from bpy.props import EnumProperty
from mathutils import Vector

from . import handles, vertex_groups
from .guarded import Guarded
from .poses import pose_of_target
from .problem import Problem

# The size of a new empty, as a share of the mesh's.
_EMPTY = 0.08


class SHAPESPACE_OT_handle_add(Guarded, bpy.types.Operator):
    """Make the active vertex group a handle of the mesh"""

    bl_idname = "shapespace.handle_add"
    bl_label = "Add Handle"

    moves: EnumProperty(
        name="Motion",
        description="What the handle's vertices do",
        items=[
            ("FIXED", "Fixed", "They stay where they are"),
            ("EMPTY", "Empty", "They follow a new empty in their middle"),
        ],
    )

    @staticmethod
    def require(context) -> None:
        item = handles.mesh_of(context)
        if item.vertex_groups.active is None:
            raise Problem(
                f"'{item.name}' has no vertex group: assign vertices to one, in the tab Object Data"
                " of the properties"
            )

    def change(self, context):
        item = handles.mesh_of(context)
        name = item.vertex_groups.active.name
        held = vertex_groups.members(item, name, item.data.vertices, "would be the handle")
        poses = pose_of_target(context, item)  # before anything is changed, since it may be refused
        handle = handles.of(item).add()
        handle.vertex_group = name
        setattr(item, handles.ACTIVE, len(handles.of(item)) - 1)
        if self.moves == "EMPTY":
            handle.moves = "TARGET"
            handle.target = _add_empty(context, item, name, poses, held)


class SHAPESPACE_OT_handle_remove(Guarded, bpy.types.Operator):
    """Remove the active handle of the mesh. Its vertex group and its target stay"""

    bl_idname = "shapespace.handle_remove"
    bl_label = "Remove Handle"

    @staticmethod
    def require(context) -> None:
        handles.require_some(handles.mesh_of(context))

    def change(self, context):
        item = handles.mesh_of(context)
        active = getattr(item, handles.ACTIVE)
        handles.of(item).remove(active)
        setattr(item, handles.ACTIVE, max(0, min(active, len(handles.of(item)) - 1)))


class SHAPESPACE_OT_handles_set_rest(Guarded, bpy.types.Operator):
    """Make the present places of all targets those from which they move the mesh at rest"""

    bl_idname = "shapespace.handles_set_rest"
    bl_label = "Set Rest"

    @staticmethod
    def require(context) -> None:
        handles.require_some(handles.mesh_of(context))

    def change(self, context):
        item = handles.mesh_of(context)
        for handle in handles.of(item):
            handle.set_rest(context)


def _add_empty(context, item, name: str, poses, held):
    """An empty in the middle of some vertices of a mesh at rest."""
    (shape,) = poses.shapes
    empty = bpy.data.objects.new(f"{name} handle", None)
    empty.empty_display_type = "SPHERE"
    empty.empty_display_size = _EMPTY * (shape.max(axis=0) - shape.min(axis=0)).max()
    empty.show_in_front = True
    empty.location = Vector(shape[held].mean(axis=0) + poses.frame.centre)
    for collection in item.users_collection:
        collection.objects.link(empty)
    context.view_layer.update()
    return empty


CLASSES = (
    SHAPESPACE_OT_handle_add,
    SHAPESPACE_OT_handle_remove,
    SHAPESPACE_OT_handles_set_rest,
)
