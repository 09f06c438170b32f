"""The operators in Blender's menus, where its search finds them too."""

import bpy

from . import buttons

_OPERATORS = (
    ("shapespace.inbetweens", "IPO_EASE_IN_OUT"),
    ("shapespace.extrapolate", "TRACKING_FORWARDS_SINGLE"),
    ("shapespace.transfer", "MOD_DATA_TRANSFER"),
    ("shapespace.fit", "MOD_SHRINKWRAP"),
    ("shapespace.average", "MOD_SMOOTH"),
    ("shapespace.bones", "ARMATURE_DATA"),
    ("shapespace.deform", "MOD_SIMPLEDEFORM"),
    ("shapespace.deform_live", "PLAY"),
    ("shapespace.repair", "TOOL_SETTINGS"),
)
_MARKER = ("shapespace.marker_add", "MARKER_HLT")


class SHAPESPACE_MT_operators(bpy.types.Menu):
    bl_label = "shapespace"
    bl_idname = "SHAPESPACE_MT_operators"

    def draw(self, context):
        for operator, icon in _OPERATORS:
            buttons.draw(self.layout, context, operator, icon)


def _draw_in_keys(menu, context) -> None:
    """In the menu of the shape keys."""
    menu.layout.separator()
    for operator, icon in _OPERATORS:
        buttons.draw(menu.layout, context, operator, icon)


def _draw_in_view(menu, _context) -> None:
    """In the menu Object of the 3D view."""
    menu.layout.separator()
    menu.layout.menu(SHAPESPACE_MT_operators.bl_idname)


def _draw_in_vertices(menu, context) -> None:
    """In the menu Vertex of the 3D view, which is there in Edit Mode."""
    menu.layout.separator()
    buttons.draw(menu.layout, context, *_MARKER)


def add() -> None:
    bpy.types.MESH_MT_shape_key_context_menu.append(_draw_in_keys)
    bpy.types.VIEW3D_MT_object.append(_draw_in_view)
    bpy.types.VIEW3D_MT_edit_mesh_vertices.append(_draw_in_vertices)


def remove() -> None:
    bpy.types.MESH_MT_shape_key_context_menu.remove(_draw_in_keys)
    bpy.types.VIEW3D_MT_object.remove(_draw_in_view)
    bpy.types.VIEW3D_MT_edit_mesh_vertices.remove(_draw_in_vertices)


CLASSES = (SHAPESPACE_MT_operators,)
