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
    """What runs, or else the figures of what ran last."""

    bl_label = "shapespace"
    bl_idname = "SHAPESPACE_PT_panel"

    def draw(self, context):
        shown = context.window_manager.shapespace_progress
        if shown.text:
            _draw_run(self.layout.box(), shown)
        if context.window_manager.shapespace_report.title:
            _draw_report(self.layout.box(), context.window_manager.shapespace_report)


class _Part(_Tab):
    bl_parent_id = "SHAPESPACE_PT_panel"


class SHAPESPACE_PT_motion(_Part, bpy.types.Panel):
    bl_label = "Motion"

    def draw_settings(self, column, context, settings):
        for name in ("shapes", "metric", "use_basis", "allow_mirrored"):
            column.prop(settings, name)
        column.separator()
        column.prop(settings, "result", expand=True)
        if settings.result == "CACHE":
            column.prop(settings, "cache_folder")
        column.prop(settings, "custom_frames")
        frames = column.column(align=True)
        frames.enabled = settings.custom_frames
        frames.prop(settings, "frame_start")
        frames.prop(settings, "frame_step", text="Step")
        column.separator()
        _draw_group(column, context, settings, "anchor_group")
        column.prop(settings, "ground")
        height = column.row()
        height.enabled = settings.ground
        height.prop(settings, "ground_height")
        column.separator()
        column.prop(settings, "smooth")
        cyclic = column.row()
        cyclic.enabled = settings.smooth
        cyclic.prop(settings, "cyclic")
        column.prop(settings, "avoid_contact")
        buttons.draw(column, context, "shapespace.inbetweens", "IPO_EASE_IN_OUT")
        column.separator()
        column.prop(settings, "steps")
        buttons.draw(column, context, "shapespace.extrapolate", "TRACKING_FORWARDS_SINGLE")
        column.separator()
        column.prop(settings, "poses_only")
        buttons.draw(column, context, "shapespace.transfer", "MOD_DATA_TRANSFER")
        column.separator()
        buttons.draw(column, context, "shapespace.fit", "MOD_SHRINKWRAP")
        column.separator()
        column.prop(settings, "modes")
        buttons.draw(column, context, "shapespace.average", "MOD_SMOOTH")


class SHAPESPACE_PT_bones(_Part, bpy.types.Panel):
    bl_label = "Bones"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_settings(self, column, context, settings):
        buttons.draw(column, context, "shapespace.bones", "ARMATURE_DATA")
        column.prop(settings, "auto_bones")
        column.prop(settings, "bone_error" if settings.auto_bones else "bones")
        for name in ("bone_weights", "bone_scale", "bone_step"):
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
    bl_options = {"DEFAULT_CLOSED"}

    def draw_settings(self, column, context, settings):
        try:
            _draw_handles(column, handles.mesh_of(context))
        except Problem:
            pass  # the buttons say why
        column.prop(settings, "deform_shapes")
        column.prop(settings, "balance")
        buttons.draw(column, context, "shapespace.deform", "MOD_SIMPLEDEFORM")
        buttons.draw(column, context, "shapespace.deform_live", "PLAY")


class SHAPESPACE_PT_repair(_Part, bpy.types.Panel):
    bl_label = "Repair"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_settings(self, column, context, settings):
        column.prop(settings, "repair_balance")
        _draw_group(column, context, settings, "sound_group")
        buttons.draw(column, context, "shapespace.repair", "TOOL_SETTINGS")


class SHAPESPACE_PT_metric(_Part, bpy.types.Panel):
    """What all operators have."""

    bl_label = "Stiffness and Tolerance"
    bl_options = {"DEFAULT_CLOSED"}

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
    SHAPESPACE_PT_motion,
    SHAPESPACE_PT_bones,
    SHAPESPACE_PT_deform,
    SHAPESPACE_PT_repair,
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


def _draw_report(box, shown) -> None:
    box.label(text=shown.title)
    column = box.column(align=True)
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
