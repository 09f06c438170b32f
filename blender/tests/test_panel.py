"""What the tab shows, and where."""

from types import SimpleNamespace

import bpy
from shapespace_addon import marker_operators, operators, panel
from support import Case


class Layout:
    """Takes the place of Blender's layout, and records what a panel draws, in its order."""

    def __init__(self):
        self.drawn = []  # pairs of a method's name and of what it draws

    def part(self, *_, **__):
        return self

    row = column = box = split = part

    def prop(self, owner, name, *_, **__):
        self.drawn.append(("setting" if owner == bpy.context.scene.shapespace else "prop", name))

    prop_search = prop

    def label(self, text="", **_):
        self.drawn.append(("label", text))

    def operator(self, name, **_):
        self.drawn.append(("operator", name))
        return bpy.context.window_manager.operator_properties_last(name)

    def template_list(self, *_, **__):
        pass

    def separator(self):
        pass


def draw(kind):
    """What a panel draws."""
    shown = SimpleNamespace(layout=Layout())
    shown.draw_settings = lambda *arguments: kind.draw_settings(shown, *arguments)
    kind.draw(shown, bpy.context)
    return shown.layout.drawn


def names(drawn, method):
    return [name for how, name in drawn if how == method]


KINDS = [kind for kind in panel.CLASSES if issubclass(kind, bpy.types.Panel)]
PARTS = [kind for kind in KINDS if kind is not panel.SHAPESPACE_PT_panel]


class Panel(Case):
    def drawn_in_parts(self):
        return [shown for kind in PARTS for shown in draw(kind)]

    def test_the_open_part_has_a_button_for_each_operator_and_nothing_else(self):
        drawn = draw(panel.SHAPESPACE_PT_panel)
        self.assertEqual({how for how, _ in drawn}, {"operator"})
        kinds = [*operators.CLASSES, *marker_operators.CLASSES]
        self.assertCountEqual(names(drawn, "operator"), [kind.bl_idname for kind in kinds])
        self.assertEqual(drawn[0], ("operator", "shapespace.inbetweens"))

    def test_all_other_parts_are_folded_at_first(self):
        for kind in PARTS:
            self.assertEqual(kind.bl_parent_id, "SHAPESPACE_PT_panel")
            self.assertIn("DEFAULT_CLOSED", kind.bl_options)

    def test_every_setting_is_in_one_of_them(self):
        settings = bpy.context.scene.shapespace
        found = []
        for result, auto_bones in (("KEYS", False), ("CACHE", True)):
            settings.result, settings.auto_bones = result, auto_bones
            found = {*found, *names(self.drawn_in_parts(), "setting")}
        for kind in operators.CLASSES:
            last = bpy.context.window_manager.operator_properties_last(kind.bl_idname)
            self.assertLessEqual({*last.bl_rna.properties.keys()} - {"rna_type"}, found)

    def test_figures_of_the_report_are_in_one_of_them(self):
        self.cube()
        bpy.ops.shapespace.inbetweens(shapes=1)
        shown = bpy.context.window_manager.shapespace_report
        labels = names(self.drawn_in_parts(), "label")
        self.assertLessEqual({figure.name for figure in shown.figures}, {*labels})
