"""Calls the Python module, in a thread of its own."""

import threading

from .problem import Problem
from .task import Result, Task

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


class ModuleRun:
    """A thread, which runs while Blender waits for events because solvers release Python's lock."""

    def __init__(self, task: Task, module):
        self.share = None
        self.text = ""
        self._task = task
        self._module = module
        self._notes = []
        self._motions = []
        self._stages = 1 + len(task.targets)
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
        return Result(self._motions, [self._named(note) for note in dict.fromkeys(self._notes)])

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
        module, task = self._module, self._task
        body = task.poses
        poses = module.Poses(
            body.shapes,
            body.topology.polygons(),
            segments=body.topology.segments,
            allow_nonmanifold=True,
        )
        self._notes += poses.warnings
        if task.modes is not None:
            self._average(poses)
            return
        options = {"metric": task.metric}
        if task.steps:
            options["tolerance"] = _EXTRAPOLATION_TOLERANCE
        if task.ends:
            options["ends"] = task.ends
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
            self._motions.append(path.vertices)

    def _average(self, poses) -> None:
        task = self._task
        if task.modes == 0:
            shape, summary = self._module.average(
                poses, metric=task.metric, certify=False, progress=self._hear
            )
            self._notes += summary.warnings
            self._motions.append(shape[None])
            return
        model = self._module.ShapeModel(modes=task.modes, metric=task.metric)
        model.fit(poses, progress=self._hear)
        self._notes += model.summary.warnings
        rows = [[0.0] * k + [1.0] for k in range(task.modes)]
        self._motions.append(model.inverse_transform([[0.0], *rows], progress=self._hear))

    def _take(self, result):
        self._notes += result.summary.warnings
        if not result.summary.converged:
            brief = repr(result.summary)  # <GeodesicSummary: NOT CONVERGED ...>
            self._notes.append(brief.partition(": ")[2].rstrip(">"))
        return result.path

    def _hear(self, stage, done, total, share) -> bool:
        self.text = stage
        if share is not None:
            self.share = (self._stage + share) / self._stages
        return not self._cancelled
