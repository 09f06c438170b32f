"""Called by blender_pictures.sh, once for each window that it pictures."""

import os
import pathlib
import shutil
import statistics
import sys
import time
import traceback

import bpy
from mathutils import Matrix, Vector

window, addon, tools, animals, pictures = sys.argv[-5:]

# The module as ./dev python installs it.
version = f"python{sys.version_info.major}.{sys.version_info.minor}"
project = pathlib.Path(__file__).resolve().parents[1]
sys.path.append(str(project / f"build/python-venv/lib/{version}/site-packages"))


def read_obj(file):
    with open(os.path.join(animals, file)) as lines:
        rows = [line.split() for line in lines]
    vertices = [tuple(map(float, row[1:4])) for row in rows if row and row[0] == "v"]
    faces = [[int(v.split("/")[0]) - 1 for v in row[1:]] for row in rows if row and row[0] == "f"]
    return vertices, faces


def make_animal(file):
    """An animal with the z axis up."""
    vertices, faces = read_obj(file)
    mesh = bpy.data.meshes.new("animal")
    mesh.from_pydata([(x, -z, y) for x, y, z in vertices], [], faces)
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    animal = bpy.data.objects.new("animal", mesh)
    bpy.context.scene.collection.objects.link(animal)
    select(animal)
    return animal


def add_key(animal, name, file):
    animal.shape_key_add(name="Basis")
    key = animal.shape_key_add(name=name)
    vertices, _ = read_obj(file)
    key.data.foreach_set("co", [value for x, y, z in vertices for value in (x, -z, y)])


def add_handle(animal, name, moves, chosen):
    """A handle for the vertices whose coordinates pass a test."""
    group = animal.vertex_groups.new(name=name)
    group.add([v.index for v in animal.data.vertices if chosen(*v.co)], 1, "REPLACE")
    animal.vertex_groups.active = group
    bpy.ops.shapespace.handle_add(moves=moves)


def select(item):
    for other in bpy.context.selected_objects:
        other.select_set(False)
    item.select_set(True)
    bpy.context.view_layer.objects.active = item


def view():
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=window, area=area, region=region)


FACING = Matrix.Rotation(1.05, 4, "Z") @ Matrix.Rotation(1.35, 4, "X")  # of the camera
BLUE, GREEN, ORANGE, BLACK = (
    (0.25, 0.45, 0.8, 1), (0.35, 0.65, 0.4, 1), (0.85, 0.5, 0.25, 1), (0, 0, 0, 1),
)  # fmt: skip


def add(scene, data, right, up, color):
    """Something at a place of the picture, in metres from its middle."""
    item = bpy.data.objects.new("shown", data)
    item.matrix_world = Matrix.Translation(FACING.to_3x3() @ Vector((right, up, 0)))
    item.color = color
    scene.collection.objects.link(item)
    return item


def add_text(scene, text, right, up):
    curve = bpy.data.curves.new("text", "FONT")
    curve.body = text
    curve.size = 0.22
    item = add(scene, curve, right, up, BLACK)
    item.matrix_world = item.matrix_world @ FACING


def blend(animal, share):
    """What Blender makes of the two keys alone."""
    mesh = bpy.data.meshes.new_from_object(animal)
    basis, stretch = (key.data for key in animal.data.shape_keys.key_blocks[:2])
    for vertex, a, b in zip(mesh.vertices, basis, stretch):
        vertex.co = a.co.lerp(b.co, share)
    return mesh


def in_between(animal, frame):
    bpy.context.scene.frame_set(frame)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return bpy.data.meshes.new_from_object(animal.evaluated_get(depsgraph))


def render_rows(animal, file):
    """Blender's blend of the two keys above, and the in-betweens below."""
    scene = bpy.data.scenes.new("rows")
    frames, gap, row = (1, 5, 9, 13, 17), 1.75, 2.45
    for i, frame in enumerate(frames):
        right = gap * (i - 2)
        pose = frame in (frames[0], frames[-1])
        add(scene, blend(animal, (frame - 1) / 16), right, row / 2, BLUE if pose else ORANGE)
        add(scene, in_between(animal, frame), right, -row / 2, BLUE if pose else GREEN)
    add_text(scene, "Blender's blend of the two keys", -1.4, row / 2 - 0.45)
    add_text(scene, "In-betweens", -0.6, -row / 2 - 0.45)

    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type = "ORTHO"
    camera.data.ortho_scale = 9.2
    camera.matrix_world = Matrix.Translation((0, 0, 0.7)) @ FACING @ Matrix.Translation((0, 0, 20))
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.display.shading.color_type = "OBJECT"
    scene.display.shading.show_cavity = True
    scene.display.render_aa = "16"
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("paper")
    scene.world.color = (1, 1, 1)
    scene.render.resolution_x, scene.render.resolution_y = 1400, 760
    scene.render.filepath = file
    bpy.ops.render.render(write_still=True, scene=scene.name)


def simulate(kind, value, x, y):
    bpy.context.window_manager.windows[0].event_simulate(type=kind, value=value, x=x, y=y)


def click(x, y):
    """In steps, since the pointer must have arrived before the button is pressed."""
    for kind, value in (
        ("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE"),
    ):  # fmt: skip
        simulate(kind, value, x, y)
        yield


def prepare():
    """The add-on, an empty scene, and the tab of the add-on."""
    bpy.ops.preferences.addon_install(filepath=addon)
    bpy.ops.preferences.addon_enable(module="shapespace_addon")
    settings = bpy.context.preferences.addons["shapespace_addon"].preferences
    settings.engine = "TOOLS" if window == "motion" else "MODULE"
    settings.tools = tools
    with view():
        bpy.context.preferences.view.smooth_view = 0
        bpy.ops.object.select_all(action="SELECT")
        bpy.ops.object.delete()
        bpy.context.area.spaces.active.show_region_ui = True


def look_from_the_right():
    with view():
        sidebar = next(r for r in bpy.context.area.regions if r.type == "UI")
        bpy.ops.view3d.view_axis(type="RIGHT")
        bpy.ops.view3d.view_selected()
        bpy.context.region_data.view_distance *= 1.4
        bpy.context.area.spaces.active.overlay.show_stats = False
    # The splash screen of a first start goes away by Esc. The fourth tab of the sidebar is ours,
    # after Item, Tool and View.
    simulate("ESC", "PRESS", 100, 300)
    simulate("ESC", "RELEASE", 100, 300)
    yield
    yield from click(sidebar.x + sidebar.width - 10, sidebar.y + sidebar.height - 180)
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == "PROPERTIES":
            area.spaces.active.context = "DATA"


def screenshot(name):
    with view():
        bpy.ops.screen.screenshot(filepath=os.path.join(pictures, name))


def motion():
    """In-betweens: the window, and a picture that compares them with Blender's blend."""
    prepare()
    animal = make_animal("animal0.obj")
    add_key(animal, "stretch", "animal1.obj")
    bpy.context.scene.frame_end = 17
    yield
    yield from look_from_the_right()
    with view():
        bpy.ops.shapespace.inbetweens("INVOKE_DEFAULT", True, shapes=15)
    while shown().text:
        yield
    bpy.context.scene.frame_set(9)
    for _ in range(5):
        yield
    screenshot("blender-window.png")
    yield
    render_rows(animal, os.path.join(pictures, "blender-inbetweens.png"))


def shown():
    """What the panel shows of a run."""
    return bpy.context.window_manager.shapespace_progress


def unfold(panel):
    """Only this part of the tab."""
    from shapespace_addon.panel import CLASSES

    for kind in CLASSES:
        if hasattr(kind, "bl_parent_id"):
            bpy.utils.unregister_class(kind)
            kind.bl_options = set() if kind.__name__ == panel else {"DEFAULT_CLOSED"}
            bpy.utils.register_class(kind)


def dragging():
    """An empty is dragged by the key G and the pointer. Prints how long updates take."""
    prepare()
    unfold("SHAPESPACE_PT_deform")
    animal = make_animal("standing0.obj")
    add_handle(animal, "feet", "FIXED", lambda x, y, z: z < 0.1 and (y > -0.1 or x < 0))
    add_handle(animal, "head", "FIXED", lambda x, y, z: z > 1.25 and y < -0.5)
    add_handle(animal, "paw", "EMPTY", lambda x, y, z: z < 0.1 and y < -0.1 and x > 0)
    paw = animal.shapespace_handles[2].target
    yield
    yield from look_from_the_right()
    with view():
        bpy.ops.shapespace.deform_live("INVOKE_DEFAULT", True, deform_shapes=5)
    while "cold" not in shown().text:
        yield
    cold = shown().text
    select(paw)
    with view():
        region = bpy.context.region
    x, y = region.x + region.width // 3, region.y + region.height // 3
    simulate("MOUSEMOVE", "NOTHING", x, y)
    yield
    for value in ("PRESS", "RELEASE"):
        simulate("G", value, x, y)
    yield
    times, last = [], None
    for step in range(1, 81):
        simulate("MOUSEMOVE", "NOTHING", x - step, y + step)
        if last is not live().last:
            last = live().last
            times.append((time.monotonic(), last.seconds, last.report["warm"]))
        yield
    for _ in range(10):
        yield
    screenshot("blender-dragging.png")
    yield
    simulate("LEFTMOUSE", "PRESS", x - 80, y + 80)
    simulate("LEFTMOUSE", "RELEASE", x - 80, y + 80)
    yield
    bpy.ops.shapespace.accept()
    while shown().text:
        yield
    solves = [seconds for _, seconds, warm in times if warm]
    updates = [b[0] - a[0] for a, b in zip(times[1:], times[2:])]
    idle = []
    simulate("G", "PRESS", x, y)
    for step in range(20):
        began = time.monotonic()
        simulate("MOUSEMOVE", "NOTHING", x - step, y + step)
        yield
        idle.append(time.monotonic() - began)
    print(
        f"{len(animal.data.polygons)} triangles, 5 shapes. {cold}. While dragged, {len(solves)} of"
        f" {len(times)} solves were warm, and took {statistics.median(solves):.2f} s (median;"
        f" {min(solves):.2f} to {max(solves):.2f}); the window was drawn with a new shape every"
        f" {statistics.median(updates):.2f} s, and without solves every"
        f" {statistics.median(idle):.2f} s"
    )


def live():
    from shapespace_addon import running

    (operator,) = running._running
    return operator._live


todo = motion() if window == "motion" else dragging()


def step():
    try:
        next(todo)
        return 0.2 if window == "motion" else 0.04
    except StopIteration:
        code = 0
    except BaseException:
        traceback.print_exc()
        code = 1
    shutil.rmtree(bpy.app.tempdir)  # which os._exit leaves
    os._exit(code)


bpy.app.timers.register(step, first_interval=1, persistent=True)
