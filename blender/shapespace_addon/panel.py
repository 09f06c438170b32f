"""The tab in the sidebar of the 3D view."""

import bpy

from . import buttons, handles
from .problem import Problem


class _Tab:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "shapespace"

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        column = self.layout.column()
        column.enabled = not context.window_manager.shapespace_progress.text
        self.draw_settings(column, context, context.scene.shapespace)

    def draw_settings(self, column, context, settings):
        raise NotImplementedError


class SHAPESPACE_PT_panel(_Tab, bpy.types.Panel):
    """What runs, and the buttons. Their settings are folded away below."""

    bl_label = "shapespace"
    bl_idname = "SHAPESPACE_PT_panel"

    def draw(self, context):
        shown = context.window_manager.shapespace_progress
        if shown.text:
            _draw_run(self.layout.box(), shown)
        _Tab.draw(self, context)

    def draw_settings(self, column, context, settings):
        first = column.column()
        first.scale_y = 1.5
        buttons.draw(first, context, "shapespace.inbetweens", "IPO_EASE_IN_OUT")
        for operators in _BUTTONS:
            row = column.row(align=True)
            for operator, icon in operators:
                buttons.draw(row, context, operator, icon)


_BUTTONS = (  # side by side, as far as their names fit
    (
        ("shapespace.extrapolate", "TRACKING_FORWARDS_SINGLE"),
        ("shapespace.transfer", "MOD_DATA_TRANSFER"),
    ),
    (("shapespace.fit", "MOD_SHRINKWRAP"), ("shapespace.marker_add", "MARKER_HLT")),
    (("shapespace.average", "MOD_SMOOTH"), ("shapespace.bones", "ARMATURE_DATA")),
    (("shapespace.deform", "MOD_SIMPLEDEFORM"), ("shapespace.repair", "TOOL_SETTINGS")),
    (("shapespace.deform_live", "PLAY"),),
)


class _Part(_Tab):
    bl_parent_id = "SHAPESPACE_PT_panel"
    bl_options = {"DEFAULT_CLOSED"}


class SHAPESPACE_PT_report(_Part, bpy.types.Panel):
    """The figures of what ran last."""

    bl_label = "Report"

    def draw(self, context):
        shown = context.window_manager.shapespace_report
        if shown.title:
            _draw_report(self.layout, shown)
        else:
            self.layout.label(text="Nothing was computed yet")


class SHAPESPACE_PT_motion(_Part, bpy.types.Panel):
    bl_label = "Motion"

    def draw_settings(self, column, context, settings):
        for name in ("shapes", "metric", "use_basis", "allow_mirrored"):
            column.prop(settings, name)
        column.separator()
        column.prop(settings, "smooth")
        cyclic = column.row()
        cyclic.enabled = settings.smooth
        cyclic.prop(settings, "cyclic")
        column.prop(settings, "avoid_contact")


class SHAPESPACE_PT_result(_Part, bpy.types.Panel):
    bl_label = "Result and Frames"

    def draw_settings(self, column, context, settings):
        column.prop(settings, "result", expand=True)
        if settings.result == "CACHE":
            column.prop(settings, "cache_folder")
        column.separator()
        column.prop(settings, "custom_frames")
        frames = column.column(align=True)
        frames.enabled = settings.custom_frames
        frames.prop(settings, "frame_start")
        frames.prop(settings, "frame_step", text="Step")


class SHAPESPACE_PT_placement(_Part, bpy.types.Panel):
    bl_label = "Anchor and Ground"

    def draw_settings(self, column, context, settings):
        _draw_group(column, context, settings, "anchor_group")
        column.prop(settings, "ground")
        height = column.row()
        height.enabled = settings.ground
        height.prop(settings, "ground_height")


class SHAPESPACE_PT_others(_Part, bpy.types.Panel):
    bl_label = "Other Motions"

    def draw_settings(self, column, context, settings):
        for name in ("steps", "poses_only", "modes"):
            column.prop(settings, name)


class SHAPESPACE_UL_handles(bpy.types.UIList):
    def draw_item(self, _context, layout, _data, handle, _icon, _active_data, _active_name):
        fixed = handle.moves == "FIXED"
        layout.label(
            text=handle.vertex_group or "no vertex group", icon="PINNED" if fixed else "EMPTY_AXIS"
        )
        if not fixed:
            layout.label(text=handle.target.name if handle.target else "no target")


class SHAPESPACE_PT_deform(_Part, bpy.types.Panel):
    bl_label = "Deform"

    def draw_settings(self, column, context, settings):
        try:
            _draw_handles(column, handles.mesh_of(context))
        except Problem:
            pass  # the buttons say why
        column.prop(settings, "deform_shapes")
        column.prop(settings, "balance")


class SHAPESPACE_PT_repair(_Part, bpy.types.Panel):
    bl_label = "Repair"

    def draw_settings(self, column, context, settings):
        column.prop(settings, "repair_balance")
        _draw_group(column, context, settings, "sound_group")


class SHAPESPACE_PT_bones(_Part, bpy.types.Panel):
    bl_label = "Bones"

    def draw_settings(self, column, context, settings):
        column.prop(settings, "auto_bones")
        column.prop(settings, "bone_error" if settings.auto_bones else "bones")
        for name in ("bone_weights", "bone_scale", "bone_step"):
            column.prop(settings, name)


class SHAPESPACE_PT_metric(_Part, bpy.types.Panel):
    """What all operators have."""

    bl_label = "Stiffness and Tolerance"

    def draw_settings(self, column, context, settings):
        _draw_group(column, context, settings, "stiffness_group")
        factor = column.row()
        factor.enabled = bool(settings.stiffness_group)
        factor.prop(settings, "stiffness_factor")
        for name in ("bending", "volume", "tolerance"):
            row = column.row(heading=name.title())
            row.prop(settings, f"custom_{name}", text="")
            value = row.row()
            value.enabled = getattr(settings, f"custom_{name}")
            value.prop(settings, name, text="")
        column.prop(settings, "loose_components")
        column.prop(settings, "open_seams")


CLASSES = (
    SHAPESPACE_UL_handles,
    SHAPESPACE_PT_panel,
    SHAPESPACE_PT_report,
    SHAPESPACE_PT_motion,
    SHAPESPACE_PT_result,
    SHAPESPACE_PT_placement,
    SHAPESPACE_PT_others,
    SHAPESPACE_PT_deform,
    SHAPESPACE_PT_repair,
    SHAPESPACE_PT_bones,
    SHAPESPACE_PT_metric,
)


def _draw_run(box, shown) -> None:
    box.label(text=shown.text)
    if not shown.live:
        bar = box.row()
        bar.enabled = False
        bar.prop(shown, "share", slider=True)
    row = box.row()
    if shown.live:
        row.operator("shapespace.accept", text="Accept", icon="EVENT_RETURN")
    row.operator("shapespace.cancel", text="Cancel", icon="EVENT_ESC")


def _draw_report(layout, shown) -> None:
    layout.label(text=shown.title)
    column = layout.column(align=True)
    for figure in shown.figures:
        row = column.split(factor=0.62)
        row.label(text=figure.name)
        row.label(text=figure.value)


def _draw_group(layout, context, settings, name: str) -> None:
    """The name of a vertex group of the active object."""
    item = context.active_object
    if item is not None and item.type == "MESH":
        layout.prop_search(settings, name, item, "vertex_groups")
    else:
        layout.prop(settings, name, icon="GROUP_VERTEX")


def _draw_handles(column, item) -> None:
    row = column.row()
    row.template_list(
        "SHAPESPACE_UL_handles", "", item, handles.HANDLES, item, handles.ACTIVE, rows=3
    )
    row.operator("shapespace.handle_remove", text="", icon="REMOVE")
    row = column.row(align=True)
    row.operator("shapespace.handle_add", text="Fixed", icon="ADD").moves = "FIXED"
    row.operator("shapespace.handle_add", text="Empty", icon="ADD").moves = "EMPTY"
    column.operator("shapespace.handles_set_rest", icon="FILE_REFRESH")
    active = getattr(item, handles.ACTIVE)
    if active < len(handles.of(item)):
        _draw_handle(column.column(), item, handles.of(item)[active])
    column.separator()


def _draw_handle(column, item, handle) -> None:
    column.prop_search(handle, "vertex_group", item, "vertex_groups", text="Group")
    column.prop(handle, "moves", expand=True)
    if handle.moves == "TARGET":
        column.prop(handle, "target")
    row = column.row(heading="Soft")
    row.prop(handle, "soft", text="")
    weight = row.row()
    weight.enabled = handle.soft
    weight.prop(handle, "weight", text="")
