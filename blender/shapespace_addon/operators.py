"""The operators. If a button calls them, they compute while Blender can be used, until they are done
or are cancelled. If a script calls them, they return when the result is there.

They do not have the option REGISTER: where Blender lets settings be changed afterwards, at the lower
left of the view, it would stand still until the new result is there.
"""

from types import SimpleNamespace

import bpy

from . import bones, deforming, engine, handles, live, poses, progress, report, running, work
from .problem import Problem
from .settings import (
    AverageSettings,
    BonesSettings,
    ContactSettings,
    DeformSettings,
    ExtrapolationSettings,
    MotionSettings,
    PlacementSettings,
    PoseSettings,
    RepairSettings,
    SmoothSettings,
    SurfaceSettings,
    TransferSettings,
)

_SECONDS_BETWEEN_POLLS = 0.1
_SECONDS_BETWEEN_LOOKS = 0.03  # at handles that are dragged


class _Operation:
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context):
        try:
            running.require_none()
            cls.require(context)
        except Problem as problem:
            cls.poll_message_set(str(problem))
            return False
        return True

    @staticmethod
    def require(context) -> None:
        """Raises a Problem if it can be seen at once that nothing can be computed."""
        raise NotImplementedError

    def execute(self, context):
        return self._guarded(context, self._execute)

    def invoke(self, context, _event):
        return self._guarded(context, self._invoke)

    def modal(self, context, event):
        if self.cancel_asked or (event.type == "ESC" and event.value == "PRESS"):
            return self._cancelled(context)
        if event.type == "TIMER":
            return self._guarded(context, self._step)
        return {"PASS_THROUGH"}

    def cancel(self, context):
        """Called by Blender too, when it quits or loads a file."""
        self._begun_work.cancel()
        self._leave(context)

    def _cancelled(self, context):
        self.cancel(context)
        self.report({"INFO"}, f"{self.bl_label}: cancelled")
        return {"CANCELLED"}

    def _run_beside_window(self, context, seconds: float) -> None:
        self.cancel_asked = False
        running.begin(self)
        self._timer = context.window_manager.event_timer_add(seconds, window=context.window)
        context.window_manager.modal_handler_add(self)

    def _leave(self, context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        running.end(self)
        progress.hide(context)

    def _begin(self, context, kind):
        preferences = context.preferences.addons[__package__].preferences
        return kind(context, SimpleNamespace(**self.as_keywords()), preferences)

    def _guarded(self, context, function):
        try:
            return function(context)
        except Problem as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}


class _Run(_Operation):
    """An operator that computes once."""

    work = None  # the class of its Work

    def _execute(self, context):
        begun = self._begin(context, self.work)
        begun.wait()
        return self._finish(context, begun)

    def _invoke(self, context):
        self._begun_work = self._begin(context, self.work)
        self._run_beside_window(context, _SECONDS_BETWEEN_POLLS)
        progress.show(context, self.bl_label, self._begun_work)
        return {"RUNNING_MODAL"}

    def _step(self, context):
        """Called by the timer while the operator runs."""
        try:
            if not self._begun_work.poll():
                progress.show(context, self.bl_label, self._begun_work)
                return {"PASS_THROUGH"}
        except BaseException:
            self._leave(context)
            raise
        self._leave(context)
        return self._finish(context, self._begun_work)

    def _finish(self, context, begun):
        report.hide(context)
        for note in begun.finish(context):
            self.report({"WARNING"}, note)
        report.show(context, self.bl_label, begun.report)
        return {"FINISHED"}


class _OfPoses(_Run):
    @staticmethod
    def require(context) -> None:
        poses.require_poses(context)


class SHAPESPACE_OT_inbetweens(
    _OfPoses,
    MotionSettings,
    PlacementSettings,
    SmoothSettings,
    ContactSettings,
    bpy.types.Operator,
):
    """Insert shapes between poses, such that the mesh is distorted least on the way. The poses are
    the shape keys of the active object, or the selected objects in the order of their names"""

    bl_idname = "shapespace.inbetweens"
    bl_label = "In-betweens"
    work = work.InBetweens


class SHAPESPACE_OT_extrapolate(
    _OfPoses, MotionSettings, PlacementSettings, ExtrapolationSettings, bpy.types.Operator
):
    """Insert shapes between poses, as In-betweens does, and continue the motion beyond the last"""

    bl_idname = "shapespace.extrapolate"
    bl_label = "Extrapolate"
    work = work.InBetweens


class SHAPESPACE_OT_transfer(_Run, MotionSettings, TransferSettings, bpy.types.Operator):
    """Give the other selected objects the motion of the active one through its shape keys. Their
    faces must be the same as its, and they must be in the pose with which its motion begins"""

    bl_idname = "shapespace.transfer"
    bl_label = "Transfer"
    work = work.Transfer

    @staticmethod
    def require(context) -> None:
        for item in work.source_and_targets(context):
            poses.require_object_mode(item)


class SHAPESPACE_OT_fit(_Run, SurfaceSettings, bpy.types.Operator):
    """Add an object with the faces of the active mesh and the shape of the other selected one, whose
    faces may be any others. In-betweens and Transfer then take both. Markers that both have say what
    belongs together"""

    bl_idname = "shapespace.fit"
    bl_label = "Fit To"
    work = work.FitOnto

    @staticmethod
    def require(context) -> None:
        work.template_and_target_objects(context)


class SHAPESPACE_OT_average(_OfPoses, PoseSettings, AverageSettings, bpy.types.Operator):
    """Add an object with the average of poses: the shape keys of the active object, or the selected
    objects. With Modes, its shape keys are the directions in which the poses vary most"""

    bl_idname = "shapespace.average"
    bl_label = "Average"
    work = work.Average


class SHAPESPACE_OT_bones(_Run, BonesSettings, bpy.types.Operator):
    """Add a copy of the active mesh that bones move as the mesh moves in the scene's frames: by shape
    keys, a cache, or anything else. It has an armature, vertex groups and an action"""

    bl_idname = "shapespace.bones"
    bl_label = "Make Bones"
    work = bones.MakeBones

    @staticmethod
    def require(context) -> None:
        poses.active_mesh(context)


class SHAPESPACE_OT_deform(_Run, DeformSettings, bpy.types.Operator):
    """Deform the active mesh, or that of the active empty, by its handles. The result is a shape
    key"""

    bl_idname = "shapespace.deform"
    bl_label = "Deform"
    work = deforming.Deform

    @staticmethod
    def require(context) -> None:
        handles.require_some(handles.mesh_of(context))


class SHAPESPACE_OT_repair(_Run, RepairSettings, bpy.types.Operator):
    """Give the active shape key, which is distorted, lengths, angles and volume of the Basis or, if
    two meshes are selected, of the mesh that is not active. The result is a shape key"""

    bl_idname = "shapespace.repair"
    bl_label = "Repair"
    work = deforming.Mend

    @staticmethod
    def require(context) -> None:
        deforming.distorted_and_sound_objects(context)


class SHAPESPACE_OT_deform_live(_Operation, DeformSettings, bpy.types.Operator):
    """Deform the active mesh while the targets of its handles are dragged, until it is accepted or
    cancelled. The result is a shape key"""

    bl_idname = "shapespace.deform_live"
    bl_label = "Deform Live"

    @staticmethod
    def require(context) -> None:
        handles.require_some(handles.mesh_of(context))
        engine.module_in_memory(context.preferences.addons[__package__].preferences)

    def modal(self, context, event):
        if event.type != "TIMER" and context.mode != "OBJECT":
            return {"PASS_THROUGH"}  # keys belong to that mode
        enter = event.type in {"RET", "NUMPAD_ENTER"} and event.value == "PRESS"
        self.accept_asked = self.accept_asked or enter
        return super().modal(context, event)

    def cancel(self, context):
        self._live.stop()
        for handlers in _after_undo():
            if self._write_again in handlers:  # not after a file was loaded
                handlers.remove(self._write_again)
        self._leave(context)

    def _execute(self, _context):
        raise Problem("Deform Live needs a window: scripts call shapespace.deform instead")

    def _invoke(self, context):
        self._live = self._begin(context, live.Live)
        self.accept_asked = False
        self._run_beside_window(context, _SECONDS_BETWEEN_LOOKS)
        # Handlers are compared by identity when they are removed.
        self._write_again = lambda *_: self._live.write_again()
        for handlers in _after_undo():
            handlers.append(self._write_again)
        report.hide(context)
        progress.show_live(context, self.bl_label, self._live.text)
        return {"RUNNING_MODAL"}

    def _step(self, context):
        try:
            changed = self._live.step(context)
        except BaseException:
            self.cancel(context)
            raise
        if changed:
            progress.show_live(context, self.bl_label, self._live.text)
            report.show(context, self.bl_label, self._live.last.report if self._live.last else {})
        if self.accept_asked and self._live.settled:
            self.cancel(context)
            return {"FINISHED"}
        return {"PASS_THROUGH"}

    def _cancelled(self, context):
        self.cancel(context)
        if self._live.restore():
            bpy.ops.ed.undo_push(message=f"{self.bl_label}: cancelled")
            self.report({"INFO"}, f"{self.bl_label}: cancelled")
        else:
            self.report({"WARNING"}, f"{self.bl_label}: cancelled outside of Object Mode; undo it")
        return {"CANCELLED"}


def _after_undo() -> tuple:
    return bpy.app.handlers.undo_post, bpy.app.handlers.redo_post


CLASSES = (
    SHAPESPACE_OT_inbetweens,
    SHAPESPACE_OT_extrapolate,
    SHAPESPACE_OT_transfer,
    SHAPESPACE_OT_fit,
    SHAPESPACE_OT_average,
    SHAPESPACE_OT_bones,
    SHAPESPACE_OT_deform,
    SHAPESPACE_OT_deform_live,
    SHAPESPACE_OT_repair,
)
