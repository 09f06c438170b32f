"""Called by blender_pictures.sh."""

import os
import shutil
import sys
import traceback

import bpy
from mathutils import Matrix, Vector

addon, tools, animals, pictures = sys.argv[-4:]


def read_obj(file):
    with open(os.path.join(animals, file)) as lines:
        rows = [line.split() for line in lines]
    vertices = [tuple(map(float, row[1:4])) for row in rows if row and row[0] == "v"]
    faces = [[int(v.split("/")[0]) - 1 for v in row[1:]] for row in rows if row and row[0] == "f"]
    return vertices, faces


def make_animal():
    """An animal that sits, with a shape key for stretching, and the z axis up."""
    (sit, faces), (stretch, _) = read_obj("animal0.obj"), read_obj("animal1.obj")
    mesh = bpy.data.meshes.new("animal")
    mesh.from_pydata([(x, -z, y) for x, y, z in sit], [], faces)
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    animal = bpy.data.objects.new("animal", mesh)
    bpy.context.scene.collection.objects.link(animal)
    animal.shape_key_add(name="Basis")
    key = animal.shape_key_add(name="stretch")
    key.data.foreach_set("co", [value for x, y, z in stretch for value in (x, -z, y)])
    animal.select_set(True)
    bpy.context.view_layer.objects.active = animal
    return animal


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


def click(x, y):
    """In steps, since the pointer must have arrived before the button is pressed."""
    window = bpy.context.window_manager.windows[0]
    for kind, value in (
        ("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE"),
    ):  # fmt: skip
        window.event_simulate(type=kind, value=value, x=x, y=y)
        yield


def steps():
    bpy.ops.preferences.addon_install(filepath=addon)
    bpy.ops.preferences.addon_enable(module="shapespace_addon")
    settings = bpy.context.preferences.addons["shapespace_addon"].preferences
    settings.engine = "TOOLS"
    settings.tools = tools
    with view():
        bpy.ops.object.select_all(action="SELECT")
        bpy.ops.object.delete()
    animal = make_animal()
    with view():
        bpy.context.area.spaces.active.show_region_ui = True
    yield
    with view():
        sidebar = next(r for r in bpy.context.area.regions if r.type == "UI")
        bpy.ops.view3d.view_axis(type="RIGHT")
        bpy.ops.view3d.view_selected()
        bpy.ops.view3d.zoom(delta=-2)
        bpy.context.area.spaces.active.overlay.show_stats = False
    # The splash screen of a first start goes away by a click. The fourth tab of the sidebar is
    # ours, after Item, Tool and View.
    yield from click(100, 300)
    yield from click(sidebar.x + sidebar.width - 10, sidebar.y + sidebar.height - 180)
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == "PROPERTIES":
            area.spaces.active.context = "DATA"
    with view():
        bpy.ops.shapespace.inbetweens("INVOKE_DEFAULT", True, shapes=15)
    while bpy.context.window_manager.shapespace_progress.text:
        yield
    bpy.context.scene.frame_end = 17
    bpy.context.scene.frame_set(9)
    for _ in range(5):
        yield
    with view():
        bpy.ops.screen.screenshot(filepath=os.path.join(pictures, "blender-window.png"))
    yield
    render_rows(animal, os.path.join(pictures, "blender-inbetweens.png"))


todo = steps()


def step():
    try:
        next(todo)
        return 0.2
    except StopIteration:
        code = 0
    except BaseException:
        traceback.print_exc()
        code = 1
    shutil.rmtree(bpy.app.tempdir)  # which os._exit leaves
    os._exit(code)


bpy.app.timers.register(step, first_interval=1, persistent=True)
