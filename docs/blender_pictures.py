"""Called by blender_pictures.sh."""

import os
import sys
import traceback

import bpy
from mathutils import Matrix

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


def look(scene, target, distance, width):
    """A camera that looks at the side of what stands at the target."""
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type = "ORTHO"
    camera.data.ortho_scale = width
    camera.matrix_world = (
        Matrix.Translation(target)
        @ Matrix.Rotation(1.05, 4, "Z")
        @ Matrix.Rotation(1.35, 4, "X")
        @ Matrix.Translation((0, 0, distance))
    )
    scene.collection.objects.link(camera)
    scene.camera = camera


def render_strip(animal, frames, file):
    """The object at some frames, beside each other; those at poses are blue."""
    scene = bpy.data.scenes.new("strip")
    gap = 1.75
    along = Matrix.Rotation(1.05, 3, "Z")
    for i, frame in enumerate(frames):
        bpy.context.scene.frame_set(frame)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        mesh = bpy.data.meshes.new_from_object(animal.evaluated_get(depsgraph))
        item = bpy.data.objects.new(f"frame {frame}", mesh)
        item.location = along.col[0] * gap * (i - (len(frames) - 1) / 2)
        item.color = (0.25, 0.45, 0.8, 1) if frame in (frames[0], frames[-1]) else (0.35, 0.65, 0.4, 1)
        scene.collection.objects.link(item)
    look(scene, (0, 0, 0.83), 20, gap * len(frames) + 0.3)
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.display.shading.light = "STUDIO"
    scene.display.shading.color_type = "OBJECT"
    scene.display.shading.show_cavity = True
    scene.display.shading.show_shadows = False
    scene.display.render_aa = "16"
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("paper")
    scene.world.color = (1, 1, 1)
    scene.render.resolution_x, scene.render.resolution_y = 1600, 390
    scene.render.resolution_percentage = 100
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
    bpy.context.preferences.view.show_splash = False
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
    # The splash screen of a first start goes away by a click. The fourth tab of the sidebar is ours,
    # after Item, Tool and View.
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
    render_strip(animal, (1, 5, 9, 13, 17), os.path.join(pictures, "blender-inbetweens.png"))


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
    os._exit(code)


bpy.app.timers.register(step, first_interval=1, persistent=True)
