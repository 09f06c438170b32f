"""Bones that move a mesh as it moves in the scene."""

import bpy
import numpy as np
from mathutils import Matrix

from . import armature, modifiers, skeleton
from .moving import motion_of
from .poses import active_mesh
from .task import Skinning
from .work import Work, body_of


class MakeBones(Work):
    """A copy of the active mesh with an armature, vertex groups and an action."""

    def poll(self) -> bool:
        """Bones can be added in Object Mode only, so that a run is not over before."""
        return super().poll() and bpy.context.mode == "OBJECT"

    def _choose(self, context) -> list:
        return [active_mesh(context).name]

    def _read(self, context) -> list:
        poses, self._frames = motion_of(context, *self._items(), self._settings.bone_step)
        return [poses]

    def _check_places(self, _context) -> None:
        pass  # a new object can always be added

    def _task(self, _context) -> Skinning:
        (poses,), settings = self._bodies, self._settings
        return Skinning(
            body_of(poses),
            None if settings.auto_bones else settings.bones,
            settings.bone_error / 100,
            settings.bone_weights,
            settings.bone_scale,
            settings.open_seams,
        )

    def _place(self, context, i: int, skin) -> list:
        (item,), (poses,) = self._items(), self._bodies
        # Coordinates of the armature have the axes of the scene, and the origin of the object.
        origin = poses.frame.matrix[:3, 3]
        offset = poses.frame.centre - origin
        copy = _copy_at_rest(item, poses)
        rig, names = armature.add(
            context,
            f"{item.name} bones",
            skin,
            poses.shapes[0],
            offset,
            copy.vertex_groups.keys(),
            item.users_collection,
        )
        rig.location = origin
        armature.animate(rig, names, skin, offset, self._frames)
        for collection in item.users_collection:
            collection.objects.link(copy)
        copy.select_set(False)
        _bind(context, copy, rig, names, skin)
        copy.parent = rig
        rest = Matrix(poses.frame.matrix.tolist())
        copy.matrix_parent_inverse = Matrix.Translation(rig.location).inverted() @ rest
        self.report = {"skin": _figures(skin, poses.shapes)}
        return []


def _copy_at_rest(item, poses):
    """The object without what moves it, in the first of the poses."""
    moving = modifiers.moving(item)
    copy = item.copy()
    copy.data = item.data.copy()
    copy.name = f"{item.name} with bones"
    copy.animation_data_clear()
    copy.constraints.clear()
    copy.matrix_basis = Matrix()
    copy.delta_location = copy.delta_rotation_euler = (0, 0, 0)
    copy.delta_rotation_quaternion = (1, 0, 0, 0)
    copy.delta_scale = (1, 1, 1)
    for name in moving:
        copy.modifiers.remove(copy.modifiers[name])
    if copy.data.shape_keys is not None:
        copy.shape_key_clear()
    copy.data.vertices.foreach_set("co", poses.own[0].astype(np.float32).reshape(-1))
    copy.data.update()
    return copy


def _bind(context, item, rig, names: list, skin) -> None:
    groups = [item.vertex_groups.new(name=name) for name in names]
    for bones, weights in zip(skin.bones.T, skin.weights.T):
        for vertex in np.flatnonzero(weights):
            groups[bones[vertex]].add([int(vertex)], weights[vertex], "ADD")
    modifiers.add_first(context, item, "Armature", "ARMATURE").object = rig


def _figures(skin, shapes: list) -> dict:
    moves = skeleton.moves(skin)
    off = np.array(
        [skeleton.posed(skin, shapes[0], move) - shape for move, shape in zip(moves, shapes)]
    )
    distances = np.linalg.norm(off, axis=2) / (np.linalg.norm(np.ptp(shapes[0], axis=0)) / 2)
    return {
        "bones": sum("scale" not in joint.tracks for joint in skin.joints),
        "error": float(np.sqrt((distances**2).mean())),
        "max_error": float(distances.max()),
    }
