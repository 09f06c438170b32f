"""How far a run is: in the status bar, at the mouse pointer, and in the panel."""

import bpy
from bpy.props import BoolProperty, FloatProperty, StringProperty


class SHAPESPACE_progress(bpy.types.PropertyGroup):
    """What the panel shows of a run; without `text` there is none."""

    share: FloatProperty(name="Done", subtype="PERCENTAGE", min=0, max=100, precision=0)
    text: StringProperty()
    live: BoolProperty()  # whether the run has no end of its own


def show(context, label: str, work) -> None:
    shown = context.window_manager.shapespace_progress
    if not shown.text:
        context.window_manager.progress_begin(0, 100)
    shown.share = 100 * (work.share or 0)
    shown.live = False
    shown.text = f"{label}: {work.text or 'starting'}"
    context.window_manager.progress_update(shown.share)
    context.workspace.status_text_set(f"{shown.text} ({shown.share:.0f}%).  Esc: cancel")
    _redraw(context)


def show_live(context, label: str, text: str) -> None:
    shown = context.window_manager.shapespace_progress
    shown.live = True
    shown.text = f"{label}: {text or 'starting'}"
    context.workspace.status_text_set(f"{shown.text}.  Enter: accept, Esc: cancel")
    _redraw(context)


def hide(context) -> None:
    shown = context.window_manager.shapespace_progress
    if not shown.live:
        context.window_manager.progress_end()
    shown.text = ""
    context.workspace.status_text_set(None)
    _redraw(context)


def _redraw(context) -> None:
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
