"""What needs a window: the operators as the panel's buttons run them, dragging, and Esc.

blender --factory-startup --enable-event-simulate --python blender/tests/gui.py -- shapespace.zip

A generator does one step each time that Blender waits for events. Ends Blender with exit code 0
or 1.
"""

import importlib.util
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


def view(kind="UI"):
    """The 3D view, for operators that are called as by a button in its sidebar, or in the view."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == kind)
    return bpy.context.temp_override(window=window, area=area, region=region)


def running():
    return bool(bpy.context.window_manager.shapespace_progress.text)


def press(key, at=(400, 400)):
    window = bpy.context.window_manager.windows[0]
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type=key, value=value, x=at[0], y=at[1])


def move_pointer(at):
    window = bpy.context.window_manager.windows[0]
    window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=at[0], y=at[1])


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


def open_panels():
    """Puts the add-on's panels into the tab of the sidebar that is open at first, all unfolded.
    Returns by their names what `count_draws` does, when all have been drawn."""
    from shapespace_addon import panel

    kinds = [kind for kind in panel.CLASSES if issubclass(kind, bpy.types.Panel)]
    for kind in reversed(kinds):
        bpy.utils.unregister_class(kind)
    for kind in kinds:
        kind.bl_category = "Item"
        kind.bl_options = set()
        bpy.utils.register_class(kind)
    drawn = [count_draws(kind) for kind in kinds]
    with view():
        bpy.context.area.spaces.active.show_region_ui = True
        bpy.context.scene.shapespace.result = "CACHE"
    yield from until(lambda: all(drawn))
    return dict(zip((kind.__name__ for kind in kinds), drawn))


def steps(folder):
    press("ESC")  # away with the splash screen
    yield

    drawn = yield from open_panels()

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
    yield from until(lambda: True in drawn["SHAPESPACE_PT_panel"])  # which shows the run
    assert running()
    (folder / "go").touch()
    yield from until(lambda: not running())
    (folder / "go").unlink()
    yield  # in which Blender gives shape keys the values of the present frame
    after = support.state()
    assert support.key_names(bpy.data.objects["animal"])[-1] == "geo 007"
    assert len(support.key_names(bpy.data.objects["animal"])) == 9
    assert support.temporary_folders() == []
    del drawn["SHAPESPACE_PT_report"][:]
    yield from until(lambda: drawn["SHAPESPACE_PT_report"])  # with the figures of the run

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

    # The button Cancel
    with view():
        bpy.ops.shapespace.inbetweens("INVOKE_DEFAULT", True, shapes=3)
        yield
        assert not bpy.ops.shapespace.accept.poll()
        bpy.ops.shapespace.cancel()
    yield from until(lambda: not running())
    assert (support.children(), support.temporary_folders()) == ([], [])
    assert support.state() == before
    assert not bpy.ops.shapespace.cancel.poll()

    # The menus, which draw what was appended last only if nothing before it fails.
    drawn = count_draws(bpy.types.SHAPESPACE_MT_operators)
    with view():
        bpy.ops.wm.call_menu("INVOKE_DEFAULT", name="SHAPESPACE_MT_operators")
    yield from until(lambda: drawn)
    press("ESC")
    yield
    for menu, mode in (
        (bpy.types.MESH_MT_shape_key_context_menu, "OBJECT"),
        (bpy.types.VIEW3D_MT_edit_mesh_vertices, "EDIT"),
        (bpy.types.VIEW3D_MT_object, "OBJECT"),
    ):
        with view():
            bpy.ops.object.mode_set(mode=mode)
        ends = []

        def end(*_):
            ends.append(True)

        menu.append(end)
        with view():
            bpy.ops.wm.call_menu("INVOKE_DEFAULT", name=menu.__name__)
        yield from until(lambda: ends)
        menu.remove(end)
        press("ESC")
        yield

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

    if importlib.util.find_spec("shapespace") is None:
        print("gui: dragging was not tested, for want of the Python module: ./dev python builds it")
    else:
        yield from live_steps(sit, faces)


def start_live():
    with view():
        assert bpy.ops.shapespace.deform_live("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield from until(lambda: shown_as("cold"))


def shown_as(start):
    return start in bpy.context.window_manager.shapespace_progress.text


def drag(empty):
    """Moves an empty as a person does, with the key G and the pointer, and yields meanwhile."""
    support.select(empty)
    with view("WINDOW"):
        region = bpy.context.region
    x, y = region.x + region.width // 3, region.y + region.height // 2
    for way in (200, 100, 0):  # away from a report, which goes when the pointer does
        move_pointer((x, y + way))
        yield
    press("G", (x, y))
    yield
    for step in range(1, 9):
        move_pointer((x + 4 * step, y))
        yield
    return x + 32, y


def live_steps(rest, faces):
    """Dragging, and how it ends."""
    support.preferences().engine = "MODULE"
    made = support.add_object("animal", rest, faces)
    support.assign(made, "feet", rest[:, 1] < 0.1)
    support.assign(made, "head", rest[:, 1] > 1.2)
    with view():
        bpy.ops.object.select_all(action="DESELECT")
        support.select(made)
        made.vertex_groups.active_index = 0
        bpy.ops.shapespace.handle_add(moves="FIXED")
        made.vertex_groups.active_index = 1
        bpy.ops.shapespace.handle_add(moves="EMPTY")
        bpy.ops.ed.undo_push(message="handles")
    with view("WINDOW"):
        bpy.ops.view3d.view_selected()

    def animal():
        return bpy.data.objects["animal"]

    def empty():
        return animal().shapespace_handles[1].target

    def head():
        """Where the head is, in the middle."""
        seen = support.seen(animal(), 1)
        return seen[rest[:, 1] > 1.2].mean(axis=0)

    def at_empty():
        return abs(head() - list(empty().matrix_world.translation)).max() < 1e-4

    # The mesh follows while the pointer moves, before the button is released; Enter accepts.
    yield from start_live()
    assert bpy.context.window_manager.shapespace_report.title == "Deform Live"
    began = head()
    pointer = yield from drag(empty())
    yield from until(lambda: shown_as("warm") and at_empty())
    assert abs(head() - began).max() > 0.01
    press("LEFTMOUSE", pointer)
    yield
    assert running()
    press("RET")
    yield from until(lambda: not running())
    assert at_empty() and support.key_names(animal()) == ["Basis", "deformed"]
    after = support.key_shape(animal(), "deformed")
    with view():
        bpy.ops.ed.undo()
    yield
    with view():
        bpy.ops.ed.redo()
    yield
    assert (support.key_shape(animal(), "deformed") == after).all()

    # Undo and redo meanwhile
    support.select(animal())
    animal().shape_key_clear()
    with view():
        bpy.ops.ed.undo_push(message="again")
    yield from start_live()
    pointer = yield from drag(empty())
    press("LEFTMOUSE", pointer)
    yield from until(at_empty)
    dragged = head()
    with view():
        bpy.ops.ed.undo()
    yield from until(lambda: abs(head() - dragged).max() > 0.01 and at_empty())
    with view():
        bpy.ops.ed.redo()
    yield from until(lambda: abs(head() - dragged).max() < 1e-3 and at_empty())

    # Edit Mode meanwhile, in which Esc is Edit Mode's
    support.select(animal())
    with view():
        bpy.ops.object.mode_set(mode="EDIT")
    yield from until(lambda: shown_as("waiting"))
    press("ESC")
    yield
    assert running()
    with view():
        bpy.ops.object.mode_set(mode="OBJECT")
    yield from until(lambda: not shown_as("waiting"))

    # Esc takes the shape key away.
    press("ESC")
    yield from until(lambda: not running())
    assert animal().data.shape_keys is None

    # The buttons
    support.select(animal())
    yield from start_live()
    with view():
        bpy.ops.shapespace.cancel()
    yield from until(lambda: not running())
    assert animal().data.shape_keys is None
    support.select(animal())
    yield from start_live()
    with view():
        bpy.ops.shapespace.accept()
    yield from until(lambda: not running())
    assert support.key_names(animal()) == ["Basis", "deformed"]

    # An object that is deleted meanwhile ends it.
    for gone in (empty, animal):
        support.select(animal())
        yield from start_live()
        with view():
            support.select(gone())
            bpy.ops.object.delete()
        yield from until(lambda: not running())
        if "animal" in bpy.data.objects:
            animal().shapespace_handles[1].moves = "FIXED"

    # So does another file.
    made = support.add_object("animal", rest, faces)
    support.assign(made, "feet", rest[:, 1] < 0.1)
    with view():
        bpy.ops.shapespace.handle_add(moves="FIXED")
    yield from start_live()
    with view():
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=False)
    yield from until(lambda: not running())
    assert not bpy.app.handlers.undo_post


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
