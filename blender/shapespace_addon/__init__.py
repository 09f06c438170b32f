"""Blender add-on: geodesic in-betweens of the poses of a mesh."""

import bpy

from . import operators, panel, preferences, progress, settings

bl_info = {
    "name": "shapespace",
    "description": "In-betweens of poses along which a mesh is distorted least",
    "author": "shapespace contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > shapespace",
    "category": "Animation",
}

_CLASSES = (
    settings.SHAPESPACE_settings,
    progress.SHAPESPACE_progress,
    preferences.SHAPESPACE_preferences,
    *operators.CLASSES,
    panel.SHAPESPACE_PT_panel,
)


def register():
    for kind in _CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.Scene.shapespace = bpy.props.PointerProperty(type=settings.SHAPESPACE_settings)
    bpy.types.WindowManager.shapespace_progress = bpy.props.PointerProperty(
        type=progress.SHAPESPACE_progress
    )


def unregister():
    operators.cancel_running()
    del bpy.types.WindowManager.shapespace_progress
    del bpy.types.Scene.shapespace
    for kind in reversed(_CLASSES):
        bpy.utils.unregister_class(kind)
