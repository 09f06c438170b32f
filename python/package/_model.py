"""A statistical model of the shapes of a body."""

import inspect
import os

import numpy as np

from . import _core
from ._functions import _has_mesh, _poses
from ._options import takes
from ._progress import told
from ._warn import warn


class NotFittedError(ValueError, AttributeError):
    """A model is asked for something before `fit`."""


class ShapeModel:
    """The mean of poses and their principal modes; coordinates are in standard deviations.

    Used as the transformers of scikit-learn are: `fit`, `transform`, `inverse_transform`, in
    pipelines, and with `sklearn.base.clone`. Parameters are attributes too, for the next `fit`.

    Parameters
    ----------
    faces : array_like, or an object with a mesh, optional
        Of poses that are arrays, where `fit` is not given them, as in pipelines.
    {options}

    Attributes
    ----------
    mean_ : ndarray
        The mean of the poses, n x 3.
    modes_ : ndarray
        Displacements of the mean by one standard deviation of each mode, k x n x 3.
    explained_variance_ratio_ : ndarray
        The modes' shares of the variance, k.
    coordinates_ : ndarray
        Of the poses, a row for each.
    names_ : list of str
        Of the poses, if they were files; otherwise their numbers.
    faces_ : ndarray
        Triangles, m x 3.
    summary_ : ShapeModelSummary
        How good the mean is, and what the modes are; None in a model that was read.
    """

    summary_ = None
    _model = None

    def __init__(self, *, faces=None, **options):
        given = inspect.signature(type(self)).bind(faces=faces, **options)
        given.apply_defaults()
        vars(self).update(given.arguments)

    def get_params(self, deep=True):
        """All parameters, as a dict."""
        return {name: getattr(self, name) for name in inspect.signature(type(self)).parameters}

    def set_params(self, **options):
        """Change parameters, for the next `fit`. Returns the model."""
        for name in options:
            if name not in self.get_params():
                raise ValueError(f"'{name}' is no parameter of ShapeModel")
        vars(self).update(options)
        return self

    def fit(self, poses, faces=None, *, progress=None):
        """Find the mean and the modes of poses.

        `poses` and `faces` are as for `interpolate`; faces are those of the model if they are left
        out. Returns the model.
        """
        options = self.get_params()
        own_faces = options.pop("faces")
        first = poses[0] if isinstance(poses, (list, tuple)) and poses else poses
        if faces is None and not _has_mesh(poses) and not _has_mesh(first):
            faces = own_faces
        poses = _poses(poses, faces)
        names = [os.path.splitext(os.path.basename(name))[0] for name in poses.names]
        if len(set(names)) < len(names) or not all(names):
            names = []
        with told(progress) as report:
            self._model, self.summary_ = _core.make_shape_model(poses, names, options, report)
        return self

    def __sklearn_is_fitted__(self):
        return self._model is not None

    def transform(self, shapes, *, fit=False, progress=None):
        """Coordinates of shapes, a row for each; with `fit`, of the shapes of the model that are
        nearest to them, vertex by vertex."""
        model = self._fitted()
        with told(progress) as report:
            return np.array(
                [model.coordinates_of(shape, fit, report)[0] for shape in _sequence(shapes, 3)]
            )

    def inverse_transform(self, coordinates, *, progress=None):
        """The shapes at coordinates, k x n x 3. Rows may have fewer coordinates than there are
        modes; the others are then zero."""
        model = self._fitted()
        shapes = []
        with told(progress) as report:
            for row in _sequence(coordinates, 2):
                shape, converged = model.at(row, report)
                if not converged:
                    warn(f"the shape at {row} was not found to the tolerance")
                shapes.append(shape)
        return np.array(shapes)

    def fit_transform(self, poses, faces=None, *, progress=None):
        """`fit`, and the coordinates of the poses."""
        return self.fit(poses, faces, progress=progress).coordinates_

    def preview(self, coordinates):
        """A shape that is near to the one at coordinates, n x 3, in milliseconds."""
        return self._fitted().preview(coordinates)

    def sample(self, count=1, *, seed=1):
        """Coordinates of random shapes, a row for each; the same ones for a seed."""
        model = self._fitted()
        return np.array([model.sample(seed + i) for i in range(count)])

    def write(self, file):
        """Write a .modes file, which contains the poses."""
        self._fitted().write(file)

    @staticmethod
    def read(file):
        """Read a .modes file."""
        model = ShapeModel()
        model._model = _core._ShapeModel.read(file)
        return model

    @property
    def mean_(self):
        return self._fitted().mean

    @property
    def modes_(self):
        return self._fitted().modes

    @property
    def explained_variance_ratio_(self):
        return self._fitted().variance_ratio

    @property
    def coordinates_(self):
        return self._fitted().coordinates

    @property
    def names_(self):
        return self._fitted().names

    @property
    def faces_(self):
        return self._fitted().faces

    def _fitted(self):
        if self._model is None:
            raise NotFittedError("this ShapeModel has no poses yet; call fit first")
        return self._model

    def __repr__(self):
        if self._model is None:
            return "<shapespace.ShapeModel, not fitted>"
        poses, modes = self.coordinates_.shape
        return f"<shapespace.ShapeModel: {poses} poses, {modes} modes>"


takes("ShapeModelOptions")(ShapeModel)


def _sequence(values, dimensions):
    """The values as a sequence, also if there is one alone."""
    values = np.asarray(values, dtype=float)
    return values[np.newaxis] if values.ndim == dimensions - 1 else values
