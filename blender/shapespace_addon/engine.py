"""Chooses what computes: the command-line tools or the Python module. A run of either has the
methods `poll`, `cancel` and `result`, and the attributes `share` (what is done, from 0 to 1,
or None while it is unknown) and `text` (the same in words)."""

import bpy

from . import module, tools
from .problem import Problem
from .task import Task


def begin(task: Task, preferences):
    """Starts a run according to the preferences. Raises Problem if nobody can compute."""
    if preferences.engine != "TOOLS":
        try:
            return module.ModuleRun(task, module.find())
        except Problem:
            if preferences.engine == "MODULE":
                raise
    folder = bpy.path.abspath(preferences.tools)
    return tools.ToolsRun(task, tools.find(folder), bpy.app.tempdir)


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
