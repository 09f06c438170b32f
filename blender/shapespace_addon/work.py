"""One run of an operator, from reading the scene to writing the result into it.

Data-blocks may come and go while it computes, so only their names are kept.
"""

import contextlib
import time

import bpy
from mathutils import Matrix

from . import engine, markers, mesh_cache, record, shape_keys, vertex_groups
from .metric import metric_of, tolerance_of
from .moving import range_of
from .poses import (
    active_mesh,
    pose_of_target,
    poses_of_keys,
    poses_of_objects,
    require_object_mode,
    selected_meshes,
    template_and_target,
)
from .problem import Problem
from .settings import Timing
from .task import Body, Fit, Task
from .topology import require_same

_SECONDS_BETWEEN_POLLS = 0.02


class Work:
    """Begins to compute when it is constructed. Every method may raise a Problem."""

    def __init__(self, context, settings, preferences):
        self._settings = settings
        self._objects = self._choose(context)
        self._bodies = self._read(context)
        self._check_places(context)
        self._run = engine.begin(self._task(context), preferences)
        self.report = {}  # of the solve, when the work is finished

    @property
    def share(self):
        """From 0 to 1, or None while it is not known."""
        return self._run.share

    @property
    def text(self) -> str:
        return self._run.text

    def poll(self) -> bool:
        """Whether the computation is over."""
        return self._run.poll()

    def wait(self) -> None:
        try:
            while not self.poll():
                time.sleep(_SECONDS_BETWEEN_POLLS)
        except KeyboardInterrupt:
            self.cancel()
            raise

    def cancel(self) -> None:
        """Leaves nothing behind."""
        self._run.cancel()

    def finish(self, context) -> list:
        """Writes the result into the scene. Returns what is worth saying about it."""
        result = self._run.result()
        for name, before, now in zip(self._objects, self._bodies, self._read(context)):
            if not before.same(now):
                raise Problem(
                    f"'{name}' has changed since the run began: the result does not fit it, and is"
                    " dropped. Start again"
                )
        self._check_places(context)
        self.report = result.report
        notes = list(result.notes)
        for i, motion in enumerate(result.motions):
            notes += self._place(context, i, motion)
        return notes

    def _choose(self, context) -> list:
        """Names of the objects to read."""
        raise NotImplementedError

    def _read(self, context) -> list:
        """The poses of these objects."""
        raise NotImplementedError

    def _check_places(self, context) -> None:
        """Raises a Problem if the result cannot be written."""
        raise NotImplementedError

    def _task(self, context):
        """What to compute: a task of any kind."""
        raise NotImplementedError

    def _place(self, context, i: int, motion) -> list:
        """Writes one motion into the scene. Returns what is worth saying about it."""
        raise NotImplementedError

    def _items(self) -> list:
        for name in self._objects:
            if name not in bpy.data.objects:
                raise Problem(f"'{name}' is gone: what was computed for it is dropped")
        return [bpy.data.objects[name] for name in self._objects]

    def _check_place(self, item) -> None:
        if self._settings.result == "CACHE":
            mesh_cache.require_editable(item)
            mesh_cache.file_for(item.name, self._settings.cache_folder)
        else:
            shape_keys.require_editable(item)

    def _put(self, context, item, motion, poses: dict, transferred=(), unseen=()) -> list:
        timing = self._timing(context, len(motion))
        if self._settings.result == "CACHE":
            file = mesh_cache.file_for(item.name, self._settings.cache_folder)
            mesh_cache.add_motion(context, item, motion, file, timing)
            return []
        mesh_cache.remove(item)
        return shape_keys.add_motion(item, motion, poses, timing, transferred, unseen)

    def _require_frames(self, context) -> None:
        """Raises a Problem if the scene has too few frames for a motion."""
        first, last = range_of(context.scene)
        if first == last and not self._settings.custom_frames:
            raise Problem(
                f"The scene '{context.scene.name}' begins and ends at frame {first}: let it end later,"
                " or choose Custom Frames"
            )

    def _timing(self, context, count: int) -> Timing:
        """Of a motion of so many shapes."""
        if self._settings.custom_frames:
            return Timing(self._settings.frame_start, self._settings.frame_step)
        first, last = range_of(context.scene)
        if self._ends() == "periodic":
            last += 1  # where the first pose is shown again: the range plays as a loop
        return Timing(first, (last - first) / (count - 1))

    def _ends(self) -> str:
        """How a motion through several poses begins and ends."""
        return ""


class PosesOfSelection(Work):
    """Something made of the shape keys of one object, or of several objects."""

    def _choose(self, context) -> list:
        return [item.name for item in selected_meshes(context)]

    def _read(self, context) -> list:
        items = self._items()
        if len(items) > 1:
            return [poses_of_objects(context, items)]
        return [poses_of_keys(context, items[0], self._settings.use_basis)]

    @contextlib.contextmanager
    def _vertices(self, context):
        """The first object's vertices that correspond to those of the poses."""
        first, *others = self._items()
        if not others:
            yield first.data.vertices
            return
        evaluated = first.evaluated_get(context.evaluated_depsgraph_get())
        try:
            yield evaluated.to_mesh().vertices
        finally:
            evaluated.to_mesh_clear()


class InBetweens(PosesOfSelection):
    """A motion through the shape keys of one object, or through several objects."""

    def _check_places(self, context) -> None:
        self._require_frames(context)
        if len(self._objects) > 1:
            if self._settings.result == "CACHE":
                mesh_cache.file_for(self._new_name(), self._settings.cache_folder)
            return
        (item,) = self._items()
        self._check_place(item)
        if self._settings.result == "KEYS":
            shape_keys.require_free(item, self._bodies[0].names)

    def _task(self, context) -> Task:
        (poses,) = self._bodies
        settings, first = self._settings, self._items()[0]
        anchor = ground = None
        if settings.ground:
            ground = float(settings.ground_height - poses.frame.centre[2])
        with self._vertices(context) as vertices:
            metric = metric_of(settings, settings.metric, first, vertices)
            if settings.anchor_group:
                anchor = vertex_groups.members(first, settings.anchor_group, vertices, "is to stand")
        return Task(
            body_of(poses),
            settings.shapes,
            metric,
            steps=getattr(settings, "steps", 0),
            ends=self._ends(),
            avoid_contact=getattr(settings, "avoid_contact", False),
            tolerance=tolerance_of(settings),
            allow_mirrored=settings.allow_mirrored,
            anchor=anchor,
            ground=ground,
        )

    def _ends(self) -> str:
        if not getattr(self._settings, "smooth", False):
            return ""
        return "periodic" if self._settings.cyclic else "natural"

    def _place(self, context, i: int, motion) -> list:
        first, *others = self._items()
        (poses,) = self._bodies
        motion = poses.frame.to_object(motion)
        if others:
            return self._place_new(context, first, poses, motion)
        notes = self._put_through(context, first, motion, poses.names)
        return notes + self._notes_on_drivers(shape_keys.driven(first, poses.names))

    def _place_new(self, context, first, poses, motion) -> list:
        """A copy of the first object as it is seen moves. It is alone selected, so that settings
        can be changed and the operator be run again, on it."""

        def fill(item):
            names = []
            if self._settings.result == "KEYS":
                own = [poses.frame.to_object(shape) for shape in poses.shapes]
                names = shape_keys.add_poses(item, poses.names, own)
            return self._put_through(context, item, motion, names)

        return _add_copy(context, first, poses, self._new_name(), fill)

    def _put_through(self, context, item, motion, names: list) -> list:
        """Writes the motion. On the ground poses are elsewhere than the keys of these names, and
        keys with drivers cannot be turned on and off: shapes of their own show these poses."""
        if self._settings.result == "CACHE":
            return self._put(context, item, motion, {})
        at = self._at(names)
        driven = shape_keys.driven(item, names)
        free = {index: name for index, name in at.items() if name not in driven}
        if not self._settings.ground:
            return self._put(context, item, motion, free)
        basis = item.data.shape_keys.reference_key.name
        unseen = [name for name in dict.fromkeys(free.values()) if name != basis]
        return self._put(context, item, motion, {}, unseen=unseen)

    def _at(self, names: list) -> dict:
        """The poses' names by their numbers in the motion, which may end with the first."""
        if self._ends() == "periodic":
            names = [*names, names[0]]
        return {pose * (self._settings.shapes + 1): name for pose, name in enumerate(names)}

    def _notes_on_drivers(self, driven: list) -> list:
        if not driven:
            return []
        names = ", ".join(f"'{name}'" for name in driven)
        note = f"Drivers of {names} were ignored: these keys are poses as they are at value 1"
        if self._settings.result == "KEYS":
            note += ". Where a driver turns its key on, that is added to the motion"
        return [note]

    def _new_name(self) -> str:
        return f"{self._objects[0]} in-betweens"


class Average(PosesOfSelection):
    """A new object with the average of the shape keys of one object, or of several objects."""

    def _check_places(self, _context) -> None:
        pass  # a new object can always be added

    def _task(self, context) -> Task:
        (poses,) = self._bodies
        with self._vertices(context) as vertices:
            metric = metric_of(self._settings, self._settings.metric, self._items()[0], vertices)
        return Task(
            body_of(poses),
            0,
            metric,
            modes=self._settings.modes,
            allow_mirrored=self._settings.allow_mirrored,
        )

    def _place(self, context, i: int, motion) -> list:
        first = self._items()[0]
        (poses,) = self._bodies
        mean, *modes = poses.frame.to_object(motion)

        def fill(item):
            if item.data.shape_keys is not None:
                item.shape_key_clear()
            item.data.vertices.foreach_set("co", mean.astype("f4").reshape(-1))
            if modes:
                names = [f"Mode {k + 1}" for k in range(len(modes))]
                for name in shape_keys.add_poses(item, ["Basis", *names], [mean, *modes])[1:]:
                    key = item.data.shape_keys.key_blocks[name]
                    key.slider_min, key.slider_max = -3, 3
            item.data.update()
            return []

        return _add_copy(context, first, poses, f"{self._objects[0]} average", fill)


class Transfer(Work):
    """The motion of the active object for the other selected ones."""

    def _choose(self, context) -> list:
        return [item.name for item in source_and_targets(context)]

    def _read(self, context) -> list:
        source, *targets = self._items()
        poses = poses_of_keys(context, source, self._settings.use_basis)
        rest = [pose_of_target(context, item) for item in targets]
        for body in rest:
            require_same(poses.topology, source.name, body.topology, body.names[0])
        return [poses, *rest]

    def _check_places(self, context) -> None:
        self._require_frames(context)
        items = self._items()
        for i, item in enumerate(items):
            if item.data in [other.data for other in items[:i]]:
                raise Problem(
                    f"'{item.name}' shares its mesh with another of the selected objects: make it"
                    " single user first (Object > Relations > Make Single User > Object & Data)"
                )
        for item in items[1:]:
            self._check_place(item)

    def _task(self, _context) -> Task:
        poses, *targets = self._bodies
        source = self._items()[0]
        return Task(
            body_of(poses),
            self._inserted(),
            metric_of(self._settings, self._settings.metric, source, source.data.vertices),
            targets=[body_of(target) for target in targets],
            tolerance=tolerance_of(self._settings),
            allow_mirrored=self._settings.allow_mirrored,
        )

    def _place(self, context, i: int, motion) -> list:
        target = self._items()[1 + i]
        poses, body = self._bodies[0], self._bodies[1 + i]
        motion = body.frame.to_object(motion)
        spacing = self._inserted() + 1
        if self._settings.result == "CACHE":
            return self._put(context, target, motion, {})
        if target.data.shape_keys is None:
            target.shape_key_add(name="Basis", from_mix=False)
        shape_keys.remove(target, record.transferred(target.data.shape_keys))
        names = shape_keys.add_poses(target, poses.names[1:], motion[spacing::spacing])
        reached = [target.data.shape_keys.reference_key.name, *names]
        return self._put(
            context,
            target,
            motion,
            {pose * spacing: name for pose, name in enumerate(reached)},
            transferred=names,
        )

    def _inserted(self) -> int:
        return 0 if self._settings.poses_only else self._settings.shapes


class FitOnto(Work):
    """A new object with the faces of the active mesh and the shape of the other selected one."""

    def _choose(self, context) -> list:
        return [item.name for item in template_and_target_objects(context)]

    def _read(self, context) -> list:
        return template_and_target(context, *self._items())

    def _check_places(self, _context) -> None:
        pass  # a new object can always be added

    def poll(self) -> bool:
        try:
            return super().poll()
        except Problem as problem:
            raise Problem(markers.with_names(str(problem), self._markers)) from None

    def finish(self, context) -> list:
        return [markers.with_names(note, self._markers) for note in super().finish(context)]

    def _task(self, context) -> Fit:
        template, target = self._bodies
        pairs, self._notes = markers.pairs_of(context, *self._items())
        self._markers = list(pairs)
        return Fit(
            body_of(template), [body_of(target)], list(pairs.values()), self._settings.open_seams
        )

    def _place(self, context, i: int, motion) -> list:
        """The template is selected too, so that In-betweens can be pressed."""
        template, target = self._items()
        body = self._bodies[1]
        (fitted,) = body.frame.to_object(motion)

        def fill(item):
            item.data.vertices.foreach_set("co", fitted.astype("f4").reshape(-1))
            item.data.update()
            return []

        notes = _add_copy(context, template, body, f"{template.name} as {target.name}", fill)
        template.select_set(True)
        if self.report["warnings"]:
            notes.append(
                f"Look whether each part of '{context.active_object.name}' is where it belongs. If"
                f" one is not, select a vertex of it in '{template.name}' and the one to which it"
                f" belongs in '{target.name}', both in Edit Mode, press Add Marker, and press Fit To"
                " again"
            )
        return self._notes + notes


def template_and_target_objects(context) -> list:
    """The active mesh, and the other selected one. Raises a Problem unless there are these two."""
    template = active_mesh(context)
    others = [item for item in selected_meshes(context) if item != template]
    if len(others) != 1:
        raise Problem(
            f"Two meshes are needed: select the body onto which '{template.name}' is to be fitted,"
            f" and '{template.name}' last"
        )
    require_object_mode(others[0])
    return [template, *others]


def source_and_targets(context) -> list:
    """The active mesh, and then the other selected ones. Raises a Problem unless there are some."""
    source = context.active_object
    if source is None or source.type != "MESH":
        raise Problem("The active object is no mesh: select the targets, and the source last")
    targets = [item for item in selected_meshes(context) if item != source]
    if not targets:
        raise Problem(
            f"No target is selected: select bodies with the mesh of '{source.name}', and"
            f" '{source.name}' last"
        )
    return [source, *targets]


def _add_copy(context, first, poses, name: str, fill) -> list:
    """Adds a copy of an object as it is seen, which fill(item) changes, and selects it alone.
    Returns what `fill` does."""
    depsgraph = context.evaluated_depsgraph_get()
    mesh = bpy.data.meshes.new_from_object(first.evaluated_get(depsgraph), depsgraph=depsgraph)
    item = bpy.data.objects.new(name, mesh)
    try:
        notes = fill(item)
    except Problem:
        bpy.data.objects.remove(item)
        bpy.data.meshes.remove(mesh)
        raise
    for collection in first.users_collection:
        collection.objects.link(item)
    item.matrix_world = Matrix(poses.frame.matrix.tolist())
    for selected in context.selected_objects:
        selected.select_set(False)
    item.select_set(True)
    context.view_layer.objects.active = item
    return notes


def body_of(poses) -> Body:
    return Body(poses.names, poses.shapes, poses.topology)
