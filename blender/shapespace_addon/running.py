"""The operator that runs beside the window, if there is one."""

import bpy

from .problem import Problem

_running = []


def begin(operator) -> None:
    require_none()
    _running.append(operator)


def end(operator) -> None:
    _running.remove(operator)


def require_none() -> None:
    if _running:
        raise Problem("A run is going on already: wait for it, or cancel it by Esc")


def cancel_all(context) -> None:
    """For the end of the add-on."""
    for operator in list(_running):
        operator.cancel(context)


class _Button:
    """A button that tells the running operator to end."""

    word = ""  # the attribute of the operator that is set

    @classmethod
    def poll(cls, _context):
        cls.poll_message_set("Nothing is running")
        return any(hasattr(operator, cls.word) for operator in _running)

    def execute(self, _context):
        for operator in _running:
            setattr(operator, self.word, True)
        return {"FINISHED"}


class SHAPESPACE_OT_cancel(_Button, bpy.types.Operator):
    """End what is running, and leave everything as it was before. So does Esc"""

    bl_idname = "shapespace.cancel"
    bl_label = "Cancel"
    word = "cancel_asked"


class SHAPESPACE_OT_accept(_Button, bpy.types.Operator):
    """End dragging, and keep the deformed shape. So does Enter"""

    bl_idname = "shapespace.accept"
    bl_label = "Accept"
    word = "accept_asked"


CLASSES = (SHAPESPACE_OT_cancel, SHAPESPACE_OT_accept)
