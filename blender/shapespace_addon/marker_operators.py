"""The operator that adds a marker for Fit To."""

import bmesh
import bpy

from . import markers
from .guarded import Guarded
from .problem import Problem


class SHAPESPACE_OT_marker_add(Guarded, bpy.types.Operator):
    """Mark two vertices that belong together, so that Fit To brings one onto the other. Select one
    vertex of each of two meshes that are in Edit Mode together: it is put into a vertex group that
    has the same name in both"""

    bl_idname = "shapespace.marker_add"
    bl_label = "Add Marker"

    @staticmethod
    def require(context) -> None:
        items = _edited(context)
        if len(items) != 2:
            raise Problem(
                "Two meshes must be in Edit Mode: select both in Object Mode, change to Edit Mode,"
                " and select one vertex of each"
            )
        for item in items:
            if item.data.total_vert_sel != 1:
                raise Problem(
                    f"{item.data.total_vert_sel} vertices of '{item.name}' are selected: select"
                    " one of each mesh, two that belong together"
                )

    def change(self, context):
        items = _edited(context)
        name = _free_name(items)
        for item in items:
            group = item.vertex_groups.new(name=name)
            content = bmesh.from_edit_mesh(item.data)
            weights = content.verts.layers.deform.verify()
            (chosen,) = (vertex for vertex in content.verts if vertex.select)
            chosen[weights][group.index] = 1
            bmesh.update_edit_mesh(item.data, loop_triangles=False, destructive=False)
        self.report({"INFO"}, f"'{items[0].name}' and '{items[1].name}' have the marker '{name}'")


def _edited(context) -> list:
    """The meshes in Edit Mode. Of objects that share one, it is the first."""
    return context.objects_in_mode_unique_data if context.mode == "EDIT_MESH" else []


def _free_name(items) -> str:
    """As Blender numbers names, but free in all of these objects."""
    name, number = markers.PREFIX, 0
    while any(name in item.vertex_groups for item in items):
        number += 1
        name = f"{markers.PREFIX}.{number:03d}"
    return name


CLASSES = (SHAPESPACE_OT_marker_add,)
