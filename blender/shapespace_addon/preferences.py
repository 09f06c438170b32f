"""Where the solvers are."""

import bpy
from bpy.props import EnumProperty, StringProperty

from . import engine
from .problem import Problem


class SHAPESPACE_preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    engine: EnumProperty(
        name="Compute With",
        items=[
            ("AUTOMATIC", "Automatic", "The Python module if it can be imported, else the tools"),
            ("TOOLS", "Tools", "The command-line tools, as processes of their own"),
            ("MODULE", "Python Module", "The Python module, inside Blender"),
        ],
    )
    tools: StringProperty(
        name="Folder of the Tools",
        description="It contains shape-interpolate, shape-deform and the others. If it is empty, they"
        " are looked for in PATH",
        subtype="DIR_PATH",
    )

    def draw(self, _context):
        column = self.layout.column()
        column.prop(self, "engine")
        tools = column.row()
        tools.enabled = self.engine != "MODULE"
        tools.prop(self, "tools")
        try:
            column.label(text=engine.describe(self), icon="CHECKMARK")
        except Problem as problem:
            column.label(text=str(problem), icon="ERROR")
