"""What Python adds to `Metric`: its signature, and its matrix as scipy has it."""

import inspect

from ._core import Metric
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


Metric.matrix = matrix
