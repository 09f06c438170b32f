"""From an object's coordinates to those in which shapes are computed, and back."""

import numpy as np


class Frame:
    """Shapes are computed as they stand in the scene, because an object may be scaled more along
    one axis than along another. They are relative to `centre`, so that bodies far from the scene's
    origin keep their digits in files of single precision."""

    def __init__(self, matrix: np.ndarray, centre=(0.0, 0.0, 0.0)):
        self.matrix = matrix  # of the object, 4 x 4
        self.centre = np.asarray(centre)
        self._linear = matrix[:3, :3]
        self._offset = matrix[:3, 3] - centre

    def to_scene(self, vertices: np.ndarray) -> np.ndarray:
        return vertices @ self._linear.T + self._offset

    def to_object(self, vertices: np.ndarray) -> np.ndarray:
        return np.linalg.solve(self._linear, (vertices - self._offset).reshape(-1, 3).T).T.reshape(
            vertices.shape
        )
