"""Blender add-on: geodesic in-betweens of the poses of a mesh, and deformation by handles."""

import bpy

from . import (
    handle_operators,
    handles,
    marker_operators,
    menus,
    operators,
    panel,
    preferences,
    progress,
    report,
    running,
    settings,
)

bl_info = {
    "name": "shapespace",
    "description": "In-betweens of poses, and deformation by handles",
    "author": "shapespace contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > shapespace",
    "category": "Animation",
}

_CLASSES = (
    settings.SHAPESPACE_settings,
    handles.SHAPESPACE_handle,
    progress.SHAPESPACE_progress,
    report.SHAPESPACE_figure,
    report.SHAPESPACE_report,
    preferences.SHAPESPACE_preferences,
    *handle_operators.CLASSES,
    *marker_operators.CLASSES,
    *running.CLASSES,
    *operators.CLASSES,
    *panel.CLASSES,
    *menus.CLASSES,
)


def register():
    for kind in _CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.Scene.shapespace = bpy.props.PointerProperty(type=settings.SHAPESPACE_settings)
    bpy.types.WindowManager.shapespace_progress = bpy.props.PointerProperty(
        type=progress.SHAPESPACE_progress
    )
    bpy.types.WindowManager.shapespace_report = bpy.props.PointerProperty(
        type=report.SHAPESPACE_report
    )
    setattr(
        bpy.types.Object,
        handles.HANDLES,
        bpy.props.CollectionProperty(type=handles.SHAPESPACE_handle),
    )
    setattr(bpy.types.Object, handles.ACTIVE, bpy.props.IntProperty())
    menus.add()


def unregister():
    running.cancel_all(bpy.context)
    menus.remove()
    delattr(bpy.types.Object, handles.ACTIVE)
    delattr(bpy.types.Object, handles.HANDLES)
    del bpy.types.WindowManager.shapespace_report
    del bpy.types.WindowManager.shapespace_progress
    del bpy.types.Scene.shapespace
    for kind in reversed(_CLASSES):
        bpy.utils.unregister_class(kind)
