"""The operators. If a button calls them, they compute while Blender can be used, until they are done
or Esc is pressed. If a script calls them, they return when the result is there."""

from types import SimpleNamespace

import bpy

from . import progress
from .problem import Problem
from .settings import (
    AverageSettings,
    ExtrapolationSettings,
    MotionSettings,
    PoseSettings,
    SmoothSettings,
    TransferSettings,
)
from .work import Average, InBetweens, Transfer

_SECONDS_BETWEEN_POLLS = 0.1
_running = []  # the operator that runs beside the window, if there is one


class _Operation:
    bl_options = {"REGISTER", "UNDO"}
    work = None  # the class of its Work

    def execute(self, context):
        return self._guarded(context, self._execute)

    def invoke(self, context, _event):
        return self._guarded(context, self._invoke)

    def modal(self, context, event):
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            self.report({"INFO"}, f"{self.bl_label}: cancelled")
            return {"CANCELLED"}
        if event.type == "TIMER":
            return self._guarded(context, self._step)
        return {"PASS_THROUGH"}

    def cancel(self, context):
        """Called by Blender too, when it quits or loads a file."""
        self._begun.cancel()
        self._leave(context)

    def _execute(self, context):
        begun = self._begin(context)
        begun.wait()
        return self._finish(context, begun)

    def _invoke(self, context):
        if _running:
            raise Problem("A run is going on already: wait for it, or cancel it by Esc")
        self._begun = self._begin(context)
        self._timer = context.window_manager.event_timer_add(
            _SECONDS_BETWEEN_POLLS, window=context.window
        )
        context.window_manager.modal_handler_add(self)
        _running.append(self)
        progress.show(context, self.bl_label, self._begun)
        return {"RUNNING_MODAL"}

    def _step(self, context):
        """Called by the timer while the operator runs."""
        try:
            if not self._begun.poll():
                progress.show(context, self.bl_label, self._begun)
                return {"PASS_THROUGH"}
        except BaseException:
            self._leave(context)
            raise
        self._leave(context)
        return self._finish(context, self._begun)

    def _leave(self, context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        _running.remove(self)
        progress.hide(context)

    def _begin(self, context):
        preferences = context.preferences.addons[__package__].preferences
        return self.work(context, SimpleNamespace(**self.as_keywords()), preferences)

    def _finish(self, context, begun):
        for note in begun.finish(context):
            self.report({"WARNING"}, note)
        return {"FINISHED"}

    def _guarded(self, context, function):
        try:
            return function(context)
        except Problem as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}


class SHAPESPACE_OT_inbetweens(_Operation, MotionSettings, SmoothSettings, bpy.types.Operator):
    """Insert shapes between poses, such that the mesh is distorted least on the way. The poses are
    the shape keys of the active object, or the selected objects in the order of their names"""

    bl_idname = "shapespace.inbetweens"
    bl_label = "In-betweens"
    work = InBetweens


class SHAPESPACE_OT_extrapolate(_Operation, MotionSettings, ExtrapolationSettings, bpy.types.Operator):
    """Insert shapes between poses, as In-betweens does, and continue the motion beyond the last"""

    bl_idname = "shapespace.extrapolate"
    bl_label = "Extrapolate"
    work = InBetweens


class SHAPESPACE_OT_transfer(_Operation, MotionSettings, TransferSettings, bpy.types.Operator):
    """Give the other selected objects the motion of the active one through its shape keys. Their
    faces must be the same as its, and they must be in the pose with which its motion begins"""

    bl_idname = "shapespace.transfer"
    bl_label = "Transfer"
    work = Transfer


class SHAPESPACE_OT_average(_Operation, PoseSettings, AverageSettings, bpy.types.Operator):
    """Add an object with the average of poses: the shape keys of the active object, or the selected
    objects. With Modes, its shape keys are the directions in which the poses vary most"""

    bl_idname = "shapespace.average"
    bl_label = "Average"
    work = Average


CLASSES = (
    SHAPESPACE_OT_inbetweens,
    SHAPESPACE_OT_extrapolate,
    SHAPESPACE_OT_transfer,
    SHAPESPACE_OT_average,
)


def cancel_running() -> None:
    """For the end of the add-on."""
    for operator in list(_running):
        operator.cancel(bpy.context)
