"""An armature whose bones are the joints of a skin, and the action that moves it."""

import bpy
import numpy as np
from mathutils import Matrix, Quaternion

from . import skeleton
from .skinned_gltf import Skin

# Blender blends the four numbers of a rotation, and not the angle: below this turn from one key to
# the next, in radians, that is the same within a thousandth of it.
_TURN = 0.5


def add(
    context, name: str, skin: Skin, rest: np.ndarray, offset: np.ndarray, taken, collections
):
    """Adds an armature in its rest pose; `rest` are the vertices in coordinates of the poses, to
    which `offset` is added. It is alone selected. Returns it and the names of its bones, which are
    none of those `taken`."""
    data = bpy.data.armatures.new(name)
    item = bpy.data.objects.new(name, data)
    for collection in collections:
        collection.objects.link(item)
    for selected in context.selected_objects:
        selected.select_set(False)
    item.select_set(True)
    context.view_layer.objects.active = item
    matrices = skeleton.rest_matrices(skin)
    matrices[:, :3, 3] += offset
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        bones = []
        for joint, matrix, tail in zip(skin.joints, matrices, skeleton.tails(skin, rest) + offset):
            bone = data.edit_bones.new(_free(joint.name, taken))
            bone.head, bone.tail = matrix[:3, 3], tail
            if "scale" in joint.tracks:  # along the axes of the joint
                bone.matrix = Matrix(matrix.tolist())
            if joint.parent >= 0:
                bone.parent = bones[joint.parent]
            bones.append(bone)
        names = [bone.name for bone in bones]
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")
    item.show_in_front = True
    return item, names


def animate(item, names: list, skin: Skin, offset: np.ndarray, frames: list) -> None:
    """Keyframes of the motion, in which shape k is at frame number `frames[k]`."""
    action = bpy.data.actions.new(item.name)
    item.animation_data_create().action = action
    shift = np.eye(4)
    shift[:3, 3] = offset
    moved = shift @ skeleton.moves(skin) @ np.linalg.inv(shift)
    for number, (joint, name) in enumerate(zip(skin.joints, names)):
        own = np.array(item.data.bones[name].matrix_local, np.float64)
        relative = moved[:, number]
        if joint.parent >= 0:
            relative = np.linalg.inv(moved[:, joint.parent]) @ relative
        relative = np.linalg.inv(own) @ relative @ own
        path = item.pose.bones[name].path_from_id
        for kind, track in joint.tracks.items():
            keys, values = track.keys, _VALUES[kind](relative)
            if kind == "rotation":
                keys = _with_small_turns(keys, values)
            _add_curves(action, name, path(_PROPERTIES[kind]), values[keys], [frames[k] for k in keys])


def _free(name: str, taken) -> str:
    while name in taken:
        name += "_"
    return name


def _add_curves(action, group: str, path: str, values: np.ndarray, frames: list) -> None:
    for i, column in enumerate(values.T):
        curve = action.fcurves.new(path, index=i, action_group=group)
        curve.keyframe_points.add(len(frames))
        places = np.stack([frames, column], axis=1)
        curve.keyframe_points.foreach_set("co", places.astype(np.float32).reshape(-1))
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"
        curve.update()


def _with_small_turns(keys: list, turns: np.ndarray) -> list:
    """With further keys where a rotation between two of them is large."""
    found = keys[:1]
    for last in keys[1:]:
        between = [last]
        while between:
            first, middle = found[-1], (found[-1] + between[-1]) // 2
            angle = 2 * np.arccos(min(1.0, abs(turns[first] @ turns[between[-1]])))
            if angle > _TURN and first < middle:
                between.append(middle)
            else:
                found.append(between.pop())
    return found


def _locations(matrices: np.ndarray) -> np.ndarray:
    return matrices[:, :3, 3]


def _rotations(matrices: np.ndarray) -> np.ndarray:
    turns = np.array([Matrix(matrix.tolist()).to_quaternion() for matrix in matrices])
    for before, turn in zip(turns, turns[1:]):
        if before @ turn < 0:
            turn *= -1
    return turns


def _scales(matrices: np.ndarray) -> np.ndarray:
    return np.linalg.norm(matrices[:, :3, :3], axis=1)


_PROPERTIES = {
    "translation": "location", "rotation": "rotation_quaternion", "scale": "scale"
}  # fmt: skip
_VALUES = {"translation": _locations, "rotation": _rotations, "scale": _scales}
