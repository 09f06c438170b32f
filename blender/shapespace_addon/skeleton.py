"""What joints do to the vertices of a skin, and how their bones are drawn."""

import numpy as np
from mathutils import Matrix, Quaternion

from .skinned_gltf import Joint, Skin

_SHORTEST = 0.02  # a bone's length, as a share of the body's diagonal


def rest_matrices(skin: Skin) -> np.ndarray:
    """The place and the axes of each joint in the rest pose, joints x 4 x 4, in coordinates of the
    poses."""
    return _in_poses(skin, [_matrix(joint.place, joint.turn) for joint in skin.joints])


def moves(skin: Skin) -> np.ndarray:
    """What each joint does to points of the rest pose in each shape: shapes x joints x 4 x 4."""
    back = np.linalg.inv(rest_matrices(skin))
    shapes = max(len(track.values) for joint in skin.joints for track in joint.tracks.values())
    found = []
    for shape in range(shapes):
        local = [_moved(joint, shape) for joint in skin.joints]
        found.append(_in_poses(skin, local) @ back)
    return np.array(found)


def posed(skin: Skin, rest: np.ndarray, moved: np.ndarray) -> np.ndarray:
    """The vertices in the shape in which joints do these moves, joints x 4 x 4."""
    points = np.hstack([rest, np.ones((len(rest), 1))])
    blended = np.einsum("nk,nkij->nij", skin.weights, moved[skin.bones, :3])
    return np.einsum("nij,nj->ni", blended, points)


def tails(skin: Skin, rest: np.ndarray) -> np.ndarray:
    """Where each bone ends, in coordinates of the poses: at the joint on which most of the body
    hangs, of those that follow; the last of a limb at the end of what it moves."""
    heads = rest_matrices(skin)[:, :3, 3]
    # What a bone that scales moves, its parent moves.
    parents = np.array([joint.parent for joint in skin.joints])
    scales = np.array(["scale" in joint.tracks for joint in skin.joints])
    movers = np.where(scales, parents, np.arange(len(heads)))
    own, centres = np.zeros(len(heads)), np.zeros_like(heads)
    for bones, weights in zip(movers[skin.bones].T, skin.weights.T):
        np.add.at(own, bones, weights)
        np.add.at(centres, bones, weights[:, np.newaxis] * rest)
    ends = heads + 2 * (centres / np.maximum(own, 1e-9)[:, np.newaxis] - heads)
    hanging, heaviest = own.copy(), np.zeros(len(heads))
    for child in range(len(heads) - 1, 0, -1):  # children before their parents
        parent = parents[child]
        hanging[parent] += hanging[child]
        if hanging[child] > heaviest[parent]:
            heaviest[parent], ends[parent] = hanging[child], heads[child]
    shortest = _SHORTEST * np.linalg.norm(np.ptp(rest, axis=0))
    too_short = np.linalg.norm(ends - heads, axis=1) < shortest
    ends[too_short] = heads[too_short] + [0, 0, shortest]
    ends[scales] = ends[parents[scales]]
    return ends


def _in_poses(skin: Skin, local: list) -> np.ndarray:
    found = []
    for joint, matrix in zip(skin.joints, local):
        above = found[joint.parent] if joint.parent >= 0 else _matrix(skin.origin, (1, 0, 0, 0))
        found.append(above @ matrix)
    return np.array(found)


def _moved(joint: Joint, shape: int) -> np.ndarray:
    given = {name: track.values[shape] for name, track in joint.tracks.items()}
    matrix = _matrix(given.get("translation", joint.place), given.get("rotation", joint.turn))
    matrix[:3, :3] *= given.get("scale", np.ones(3))
    return matrix


def _matrix(place, turn) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = Matrix(Quaternion(turn).to_matrix())
    matrix[:3, 3] = place
    return matrix
