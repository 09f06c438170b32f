"""What needs a window: the operators as the panel's buttons run them, and Esc.

blender --factory-startup --enable-event-simulate --python blender/tests/gui.py -- shapespace.zip

A generator does one step each time that Blender waits for events. Ends Blender with exit code 0
or 1.
"""

import os
import pathlib
import shutil
import sys
import tempfile
import time
import traceback

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import support  # noqa: E402

SECONDS = 60  # after which a step has failed


def view():
    """The 3D view, for operators that are called as by a button in its sidebar."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "UI")
    return bpy.context.temp_override(window=window, area=area, region=region)


def running():
    return bool(bpy.context.window_manager.shapespace_progress.text)


def press(key):
    window = bpy.context.window_manager.windows[0]
    window.event_simulate(type=key, value="PRESS", x=400, y=400)
    window.event_simulate(type=key, value="RELEASE", x=400, y=400)


def choose_tools(folder):
    support.preferences().engine = "TOOLS"
    support.preferences().tools = str(folder)


def until(condition):
    end = time.monotonic() + SECONDS
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        yield


def count_draws(kind):
    """Counts how often Blender draws a panel to the end."""
    drawn = []
    draw = kind.draw

    def counted(self, context):
        draw(self, context)
        drawn.append(running())

    kind.draw = counted
    return drawn


def steps(folder):
    press("ESC")  # away with the splash screen
    yield

    # The panel, in the tab of the sidebar that is open at first.
    panel = bpy.types.SHAPESPACE_PT_panel
    bpy.utils.unregister_class(panel)
    panel.bl_category = "Item"
    bpy.utils.register_class(panel)
    drawn = count_draws(panel)
    with view():
        bpy.context.area.spaces.active.show_region_ui = True
        bpy.context.scene.shapespace.result = "CACHE"
    yield from until(lambda: drawn)

    case = support.Case()
    case.folder = folder
    # Tools that begin to work when there is a file `go`.
    wait = f"while [ ! -e '{folder}/go' ]; do sleep 0.05; done"
    support.stand_in(folder, wait + '\nexec "$tool" "$@"')
    choose_tools(folder)
    (sit, stretch), faces = case.quadruped("sit", "stretch")
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    animal = support.add_object("animal", sit, faces)
    support.add_key(animal, "stretch", stretch)
    bpy.ops.ed.undo_push(message="before")
    before = support.state()

    # A run that is waited for: the window lives on meanwhile, and the panel shows how far it is.
    with view():
        assert bpy.ops.shapespace.inbetweens("INVOKE_DEFAULT", True, shapes=7) == {"RUNNING_MODAL"}
    assert running() and len(support.children()) == 1
    with view():
        try:
            bpy.ops.shapespace.extrapolate("INVOKE_DEFAULT", True)
            raise AssertionError("a second run was begun")
        except RuntimeError as error:
            assert "A run is going on already" in str(error), error
    yield from until(lambda: True in drawn)  # the panel shows the run
    assert running()
    (folder / "go").touch()
    yield from until(lambda: not running())
    (folder / "go").unlink()
    yield  # in which Blender gives shape keys the values of the present frame
    after = support.state()
    assert support.key_names(bpy.data.objects["animal"])[-1] == "geo 007"
    assert len(support.key_names(bpy.data.objects["animal"])) == 9
    assert support.temporary_folders() == []

    with view():
        bpy.ops.ed.undo()
    assert support.state() == before
    yield
    with view():
        bpy.ops.ed.redo()
    assert support.state() == after
    yield
    with view():
        bpy.ops.ed.undo()
    yield

    # Esc
    with view():
        bpy.ops.shapespace.inbetweens("INVOKE_DEFAULT", True, shapes=3)
    yield
    assert running() and len(support.children()) == 1
    press("ESC")
    yield from until(lambda: not running())
    assert (support.children(), support.temporary_folders()) == ([], [])
    assert support.state() == before

    # The object is deleted meanwhile: a report, and no trace.
    with view():
        bpy.ops.shapespace.inbetweens("INVOKE_DEFAULT", True, shapes=3)
    bpy.data.objects.remove(bpy.data.objects["animal"])
    (folder / "go").touch()
    yield from until(lambda: not running())
    (folder / "go").unlink()
    assert "animal" not in bpy.data.objects and support.temporary_folders() == []

    # The preferences
    drawn = count_draws(type(support.preferences()))
    bpy.ops.preferences.addon_show(module=support.ADDON)
    for engine in ("AUTOMATIC", "TOOLS", "MODULE"):
        support.preferences().engine = engine
        del drawn[:]
        for window in bpy.context.window_manager.windows:
            for area in window.screen.areas:
                area.tag_redraw()
        yield from until(lambda: drawn)
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[-1]):
        bpy.ops.wm.window_close()
    choose_tools(folder)
    yield

    # Disabling the add-on, and loading a file, end a run.
    for end in (
        lambda: bpy.ops.preferences.addon_disable(module=support.ADDON),
        lambda: bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=False),
    ):
        animal = support.add_object("animal", sit, faces)
        support.add_key(animal, "stretch", stretch)
        with view():
            bpy.ops.shapespace.inbetweens("INVOKE_DEFAULT", True, shapes=3)
        yield
        assert len(support.children()) == 1
        with view():
            end()
        yield
        assert (support.children(), support.temporary_folders()) == ([], [])
        bpy.ops.preferences.addon_enable(module=support.ADDON)
        choose_tools(folder)
        yield


def main():
    bpy.ops.preferences.addon_install(filepath=sys.argv[-1])
    bpy.ops.preferences.addon_enable(module=support.ADDON)
    folder = tempfile.TemporaryDirectory()
    todo = steps(pathlib.Path(folder.name))

    def step():
        try:
            next(todo)
            return 0.05
        except StopIteration:
            print("gui: passed", flush=True)
            code = 0
        except BaseException:
            traceback.print_exc()
            code = 1
        folder.cleanup()
        shutil.rmtree(bpy.app.tempdir)  # which os._exit leaves
        os._exit(code)

    bpy.app.timers.register(step, first_interval=1, persistent=True)


main()
