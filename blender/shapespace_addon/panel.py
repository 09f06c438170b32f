"""The tab in the sidebar of the 3D view."""

import bpy


class SHAPESPACE_PT_panel(bpy.types.Panel):
    bl_label = "shapespace"
    bl_idname = "SHAPESPACE_PT_panel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "shapespace"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.shapespace
        shown = context.window_manager.shapespace_progress

        column = layout.column()
        column.enabled = not shown.text
        for name in ("shapes", "metric", "use_basis"):
            column.prop(settings, name)
        column.separator()
        column.prop(settings, "result", expand=True)
        if settings.result == "CACHE":
            column.prop(settings, "cache_folder")
        frames = column.column(align=True)
        frames.prop(settings, "frame_start")
        frames.prop(settings, "frame_step", text="Step")
        column.separator()
        column.prop(settings, "smooth")
        cyclic = column.row()
        cyclic.enabled = settings.smooth
        cyclic.prop(settings, "cyclic")
        _button(column, "shapespace.inbetweens", "IPO_EASE_IN_OUT", settings)
        column.separator()
        column.prop(settings, "steps")
        _button(column, "shapespace.extrapolate", "TRACKING_FORWARDS_SINGLE", settings)
        column.separator()
        column.prop(settings, "poses_only")
        _button(column, "shapespace.transfer", "MOD_DATA_TRANSFER", settings)
        column.separator()
        column.prop(settings, "modes")
        _button(column, "shapespace.average", "MOD_SMOOTH", settings)

        if shown.text:
            box = layout.box()
            box.label(text=shown.text)
            bar = box.row()
            bar.enabled = False
            bar.use_property_split = False
            bar.prop(shown, "share", slider=True)
            box.label(text="Esc cancels", icon="EVENT_ESC")


def _button(layout, operator: str, icon: str, settings) -> None:
    """A button that runs the operator with the scene's settings."""
    properties = layout.operator(operator, icon=icon)
    for name in properties.bl_rna.properties.keys():
        if name != "rna_type":
            setattr(properties, name, getattr(settings, name))
