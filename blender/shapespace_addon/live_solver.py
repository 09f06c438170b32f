"""Deforms one mesh again and again in a thread of its own, each time from the last solution."""

import threading
import time
from dataclasses import dataclass

import numpy as np

from .module import handles_of, options_of, poses_of
from .problem import Problem
from .task import Deformation


@dataclass
class Solved:
    """A deformed mesh."""

    handles: list  # for which it was computed
    shape: np.ndarray  # n x 3
    report: dict
    seconds: float  # from taking the handles to the shape


class LiveSolver:
    """Takes handles at any time. While it computes only the latest wait; earlier ones are dropped."""

    def __init__(self, module, deformation: Deformation):
        self._module = module
        self._deformation = deformation
        self._changed = threading.Condition()
        self._wanted = None
        self._solved = None
        self._busy = False
        self._stopped = False
        self._error = None
        threading.Thread(target=self._run, daemon=True).start()

    @property
    def busy(self) -> bool:
        """Whether handles wait, are computed with, or have a result that was not taken."""
        with self._changed:
            return self._busy or self._wanted is not None or self._solved is not None

    def give(self, handles: list) -> None:
        with self._changed:
            self._wanted = handles
            self._changed.notify()

    def take(self) -> Solved | None:
        """The last result, once. Raises a Problem if the solver failed."""
        with self._changed:
            if isinstance(self._error, self._module.Error):
                raise Problem(str(self._error))
            if self._error is not None:
                raise self._error
            solved, self._solved = self._solved, None
            return solved

    def stop(self) -> None:
        """Ends the thread at the solver's next report of progress, and does not wait for that."""
        with self._changed:
            self._stopped = True
            self._changed.notify()

    def _run(self) -> None:
        try:
            deformer = self._module.Deformer(
                poses_of(self._module, self._deformation), None, **options_of(self._deformation)
            )
            while True:
                with self._changed:
                    self._busy = False
                    self._changed.wait_for(lambda: self._stopped or self._wanted is not None)
                    if self._stopped:
                        return
                    handles, self._wanted, self._busy = self._wanted, None, True
                solved = self._solve(deformer, handles)
                with self._changed:
                    self._solved = solved
        except Exception as error:  # is raised again by take(), in Blender's own thread
            with self._changed:
                self._error = error

    def _solve(self, deformer, handles: list) -> Solved:
        began = time.monotonic()
        path, summary = deformer.deform(
            handles_of(self._module, handles), progress=lambda *_: not self._stopped
        )
        shape = path.vertices[-1]
        return Solved(handles, shape, summary.to_dict(), time.monotonic() - began)
