"""Calls the Python module, in a thread of its own."""

import threading

import numpy as np

from .problem import Problem
from .task import Deformation, Fit, Metric, Repair, Result

# The default of shape-extrapolate, so that tools and module compute the same motion.
_EXTRAPOLATION_TOLERANCE = 1e-6


def find():
    """The module `shapespace`. Raises Problem."""
    try:
        import shapespace
    except ImportError as error:
        raise Problem(
            f"The Python module shapespace cannot be imported ({error}): install it for Blender's"
            " Python, or choose the tools in the preferences of this add-on"
        ) from None
    return shapespace


def poses_of(module, task):
    """A task's poses as the module takes them."""
    return _poses(
        module,
        task.poses,
        allow_mirrored=getattr(task, "allow_mirrored", False),
        loose_components=task.metric.loose_components,
        open_seams=task.metric.open_seams,
    )


def _poses(module, body, **options):
    topology = body.topology
    return module.Poses(
        body.shapes,
        topology.polygons(),
        segments=topology.segments,
        allow_nonmanifold=True,
        **options,
    )


def handles_of(module, handles: list) -> list:
    """Handles as the module takes them."""
    found = []
    for handle in handles:
        options = {"name": handle.name}
        if handle.motion is not None:
            options.update(vars(handle.motion))
        if handle.weight is not None:
            options.update(hard=False, weight=handle.weight)
        found.append(module.Handle(handle.vertices, **options))
    return found


def options_of(task) -> dict:
    """Options of a deformation, or those that all solves have."""
    options = {"metric": _metric(task.metric)}
    if task.tolerance is not None:
        options["tolerance"] = task.tolerance
    if isinstance(task, Deformation):
        options["shapes"] = task.shapes
    if isinstance(task, (Deformation, Repair)):
        options["balance"] = task.balance
    return options


def _metric(metric: Metric) -> dict:
    given = {
        "preset": metric.preset or None,
        "bending": metric.bending,
        "volume": metric.volume,
        "stretching_stiffness": metric.stiffness,
        "bending_stiffness": metric.stiffness,
    }
    return {name: value for name, value in given.items() if value is not None}


class ModuleRun:
    """A thread, which runs while Blender waits for events because solvers release Python's lock."""

    def __init__(self, task, module):
        self.share = None
        self.text = ""
        self._task = task
        self._module = module
        self._notes = []
        self._motions = []
        self._report = {}
        self._stages = 1 if isinstance(task, Fit) else 1 + len(getattr(task, "targets", []))
        self._stage = 0
        self._cancelled = False
        self._error = None
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def poll(self) -> bool:
        """Whether the run is over. Raises Problem if it failed."""
        if self._thread.is_alive():
            return False
        if isinstance(self._error, self._module.Error):
            raise Problem(self._named(str(self._error)))
        if self._error is not None:
            raise self._error
        return True

    def cancel(self) -> None:
        """Asks the solver to stop at its next report of progress, and does not wait for that."""
        self._cancelled = True

    def result(self) -> Result:
        notes = [self._named(note) for note in dict.fromkeys(self._notes)]
        return Result(self._motions, notes, self._report)

    def _named(self, text: str) -> str:
        """With the poses' names, where the module has their numbers."""
        for i, name in enumerate(self._task.poses.names):
            text = text.replace(f"shapes[{i}]", f"'{name}'")
        return text

    def _run(self) -> None:
        try:
            self._compute()
        except Exception as error:  # is raised again by poll(), in Blender's own thread
            self._error = error

    def _compute(self) -> None:
        task = self._task
        if isinstance(task, Deformation):
            self._deform()
        elif isinstance(task, Repair):
            self._repair()
        elif isinstance(task, Fit):
            self._fit()
        elif task.modes is not None:
            self._average()
        else:
            self._move()

    def _deform(self) -> None:
        module, task = self._module, self._task
        path = self._take(
            module.deform(
                self._poses(),
                None,
                handles_of(module, task.handles),
                progress=self._hear,
                **options_of(task),
            )
        )
        self._motions.append(path.vertices)

    def _repair(self) -> None:
        task = self._task
        distorted, sound = task.poses.shapes
        both = self._poses()
        reference = self._module.Poses([sound], both)
        path = self._take(
            self._module.repair(
                reference, distorted, vertices=task.kept, progress=self._hear, **options_of(task)
            )
        )
        self._motions.append(path.vertices)

    def _fit(self) -> None:
        module, task = self._module, self._task
        options = {"loose_components": True, "open_seams": task.open_seams}
        meshes = [_poses(module, body, **options) for body in (task.poses, *task.targets)]
        for mesh in meshes:
            self._notes += mesh.warnings
        template, target = meshes
        found = module.correspond(
            template[0],
            template,
            target[0],
            target,
            markers=task.markers or None,
            find_markers=task.finds_markers,
            progress=self._hear,
        )
        self._note_end(found.summary)
        self._motions.append(found.fitted[np.newaxis])

    def _move(self) -> None:
        module, task = self._module, self._task
        poses = self._poses()
        options = options_of(task)
        if task.steps:
            options.setdefault("tolerance", _EXTRAPOLATION_TOLERANCE)
        if task.ends:
            options["ends"] = task.ends
        if task.avoid_contact:
            options["avoid_contact"] = True
        solve = module.spline if task.ends else module.interpolate
        path = None
        if task.shapes:
            path = self._take(solve(poses, shapes=task.shapes, progress=self._hear, **options))
            if task.steps:
                path = self._take(module.extrapolate(path, task.steps, progress=self._hear))
        for target in task.targets:
            self._stage += 1
            (shape,) = target.shapes
            if path is None:
                moved = module.transfer_poses(poses, shape, progress=self._hear)
            else:
                moved = module.transfer(path, shape, progress=self._hear)
            self._motions.append(self._take(moved).vertices)
        if not task.targets:
            self._motions.append(self._placed(path).vertices)

    def _placed(self, path):
        """The path, anchored and on the ground as far as that was asked for."""
        if self._task.anchor is not None:
            path = path.anchor(self._task.anchor)
        if self._task.ground is not None:
            path = path.ground("z", self._task.ground)
        return path

    def _average(self) -> None:
        task = self._task
        poses, metric = self._poses(), _metric(task.metric)
        if task.modes == 0:
            shape, summary = self._module.average(
                poses, metric=metric, certify=False, progress=self._hear
            )
            self._note(summary)
            self._motions.append(shape[np.newaxis])
            return
        model = self._module.ShapeModel(modes=task.modes, metric=metric)
        model.fit(poses, progress=self._hear)
        self._note(model.summary_)
        rows = [[0.0] * k + [1.0] for k in range(task.modes)]
        self._motions.append(model.inverse_transform([[0.0], *rows], progress=self._hear))

    def _poses(self):
        poses = poses_of(self._module, self._task)
        self._notes += poses.warnings
        return poses

    def _note(self, summary) -> None:
        self._report = summary.to_dict()
        self._notes += getattr(summary, "deformation", summary).warnings

    def _take(self, result):
        self._note_end(result.summary)
        return result.path

    def _note_end(self, summary) -> None:
        self._note(summary)
        if not summary.converged:
            brief = repr(summary)  # <GeodesicSummary: NOT CONVERGED ...>
            self._notes.append(brief.partition(": ")[2].rstrip(">"))

    def _hear(self, stage, done, total, share) -> bool:
        self.text = stage
        if share is not None:
            self.share = (self._stage + share) / self._stages
        return not self._cancelled
