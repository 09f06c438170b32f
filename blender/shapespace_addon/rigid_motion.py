"""The rigid motion from one place of an object to another one."""

import numpy as np
from mathutils import Matrix

from .task import Motion


def between(rest: np.ndarray, now: np.ndarray, centre: np.ndarray) -> Motion | None:
    """The motion that takes one 4 x 4 matrix to the other, or None if one of them is mirrored.

    Turns about the origin of `rest`, by half a circle at most. Scale and shear are left out.
    Positions are relative to `centre`.
    """
    if np.linalg.det(rest[:3, :3]) * np.linalg.det(now[:3, :3]) < 0:
        return None
    turn = _rotation(now[:3, :3]) @ _rotation(rest[:3, :3]).T
    axis, angle = Matrix(turn.tolist()).to_quaternion().to_axis_angle()
    return Motion(
        np.array(axis, float), angle, rest[:3, 3] - centre, now[:3, 3] - rest[:3, 3]
    )


def _rotation(linear: np.ndarray) -> np.ndarray:
    """The orthogonal matrix that is nearest to a matrix of full rank."""
    left, _, right = np.linalg.svd(linear)
    return left @ right
