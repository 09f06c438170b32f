"""Chooses what computes: the command-line tools or the Python module. A run of either has the
methods `poll`, `cancel` and `result`, and the attributes `share` (what is done, from 0 to 1,
or None while it is unknown) and `text` (the same in words)."""

import bpy

from . import module, tools
from .problem import Problem
from .task import Skinning


def begin(task, preferences):
    """Starts a run according to the preferences. Raises Problem if nobody can compute."""
    if isinstance(task, Skinning):
        _require_tools(preferences)
    elif preferences.engine != "TOOLS":
        try:
            return module.ModuleRun(task, module.find())
        except Problem:
            if preferences.engine == "MODULE":
                raise
    folder = bpy.path.abspath(preferences.tools)
    return tools.ToolsRun(task, tools.find(folder), bpy.app.tempdir)


def _require_tools(preferences) -> None:
    if preferences.engine == "MODULE":
        raise Problem(
            "Bones are found by the tools: choose Automatic or Tools in the preferences of this"
            " add-on"
        )


def describe(preferences) -> str:
    """What `begin` would use. Raises Problem if nobody can compute."""
    if preferences.engine != "TOOLS":
        try:
            found = module.find()
            return f"Python module, version {found.__version__}"
        except Problem:
            if preferences.engine == "MODULE":
                raise
    program = tools.find(bpy.path.abspath(preferences.tools))["shape-interpolate"]
    return f"Tools: {program}"


def module_in_memory(preferences):
    """The Python module, for what goes on from its last solution. Raises a Problem if the
    preferences choose the tools, which begin anew each time, or if it is not there."""
    if preferences.engine == "TOOLS":
        raise Problem(
            "While handles are dragged the Python module has to compute, since it goes on from its"
            " last solution: choose Automatic or Python Module in the preferences of this add-on, or"
            " press Deform after each move"
        )
    return module.find()
