"""What Python adds to `Metric`: its signature, and its matrix as scipy has it."""

import inspect

from . import _functions
from ._core import Metric, SolverError
from ._options import describe, takes

_ABOUT = """A metric, frozen on poses: immutable, so that paths under it are comparable.

    Parameters
    ----------
    poses : Poses, or sequence of array_like
        Vertices of each pose, n x 3, on which all weights are frozen.
    faces : array_like, optional
        As for `Poses`.
    preset : {'strain', 'isometric', 'rigid', 'paper'}, optional
        Sets the defaults of the options below, which are those of 'strain'.
    pairs : {'consecutive', 'all'}, optional
        Between which of the poses it is to be good: hinges that jump from one to the other are
        damped. 'all' where their order does not matter.
    {options}
    """


@takes("MetricOptions")
def _construct(poses, faces=None, *, preset="strain", pairs="consecutive", **options):
    """."""


Metric.__doc__ = inspect.cleandoc(_ABOUT).replace("{options}", describe("MetricOptions"))
Metric.__signature__ = inspect.signature(_construct)


def matrix(self, shape):
    """The metric at a shape, as a matrix on tangents.

    Parameters
    ----------
    shape : array_like
        n x 3, in the unit of the poses.

    Returns
    -------
    scipy.sparse.csc_matrix
        3n x 3n, symmetric; row and column 3 v + axis belong to a coordinate of vertex v, so that
        it takes ``tangent.ravel()``. The volume's part, of rank one and dense, is left out.

    Raises
    ------
    InvalidOptions
        The metric has a rigid part.
    """
    from scipy.sparse import csc_matrix

    data, rows, begin = self._matrix(shape)
    return csc_matrix((data, rows, begin), shape=(len(begin) - 1, len(begin) - 1))


def exp(self, shape, velocity, steps=16, **options):
    """The exponential map: `exponential` under this metric."""
    return _functions.exponential(self, shape, velocity, steps, **options)


def log(self, shape, end, steps=16, **options):
    """The logarithm: `logarithm` under this metric."""
    return _functions.logarithm(self, shape, end, steps, **options)


def dist(self, first, last, **options):
    """The length of the geodesic between two shapes, n x 3 each: a pure number.

    Options are those of `interpolate`, which says more of the path.
    """
    summary = self._geodesic(first, last, options).summary
    if not summary.converged:
        raise SolverError(f"the geodesic was not found: {summary!r}")
    return summary.energy**0.5


def transport(self, tangents, first, last, **options):
    """Carry tangents, n x 3 each, along the geodesic from one shape to another.

    Options are those of `interpolate`; `transport` carries along any path.

    Returns
    -------
    ndarray
        k x n x 3, at `last`.
    """
    path = self._geodesic(first, last, options).path
    return _functions.transport(path, tangents).tangents


def _geodesic(self, first, last, options):
    return _functions.interpolate([first, last], self, metric=self, **options)


for _method in (matrix, exp, log, dist, transport, _geodesic):
    setattr(Metric, _method.__name__, _method)
