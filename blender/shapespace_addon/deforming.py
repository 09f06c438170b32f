"""Runs that make one shape of a mesh: by handles, or by repair."""

from . import handles, shape_keys, vertex_groups
from .metric import metric_of, tolerance_of
from .poses import active_mesh, distorted_and_sound, pose_of_target, selected_meshes
from .problem import Problem
from .task import Deformation, Repair
from .work import Work, body_of

# The kinds of results, which are also the names of their shape keys.
DEFORMED = "deformed"
REPAIRED = "repaired"


def deformation(context, item, poses, settings) -> Deformation:
    """The task to deform a mesh by its handles as they are now."""
    return Deformation(
        body_of(poses),
        handles.read(context, item, handles.members(item), poses),
        settings.deform_shapes,
        settings.balance,
        metric_of(settings, "", item, item.data.vertices),
        tolerance_of(settings),
    )


class Deform(Work):
    """The active mesh, deformed by its handles, as a shape key."""

    def _choose(self, context) -> list:
        item = handles.mesh_of(context)
        handles.require_some(item)
        return [item.name]

    def _read(self, context) -> list:
        return [pose_of_target(context, *self._items())]

    def _check_places(self, _context) -> None:
        shape_keys.require_result_seen(*self._items(), DEFORMED)

    def _task(self, context) -> Deformation:
        return deformation(context, *self._items(), *self._bodies, self._settings)

    def _place(self, _context, _i: int, motion) -> list:
        (item,), (poses,) = self._items(), self._bodies
        shape_keys.show_result(item, DEFORMED, poses.frame.to_object(motion[-1]))
        return []


class Mend(Work):
    """The active shape key with the geometry of the Basis, or of another object, as a shape key."""

    def _choose(self, context) -> list:
        return [item.name for item in distorted_and_sound_objects(context)]

    def _read(self, context) -> list:
        item, *sound = self._items()
        return [distorted_and_sound(context, item, *(sound or [None]))]

    def _check_places(self, _context) -> None:
        item, *_ = self._items()
        shape_keys.require_result_seen(item, REPAIRED)

    def _task(self, _context) -> Repair:
        item, *_ = self._items()
        (poses,) = self._bodies
        settings, vertices = self._settings, item.data.vertices
        kept = None
        if settings.sound_group:
            kept = vertex_groups.members(item, settings.sound_group, vertices, "is to be kept")
        return Repair(
            body_of(poses),
            kept,
            settings.repair_balance,
            metric_of(settings, "", item, vertices),
            tolerance_of(settings),
        )

    def _place(self, _context, _i: int, motion) -> list:
        item, *_ = self._items()
        (poses,) = self._bodies
        shape_keys.turn_off(item, poses.names[0])
        shape_keys.show_result(item, REPAIRED, poses.frame.to_object(motion[-1]))
        return []


def distorted_and_sound_objects(context) -> list:
    """The active object and, where two meshes are selected, the other one. Raises a Problem unless
    there is something to repair."""
    item = active_mesh(context)
    others = [other for other in selected_meshes(context) if other != item]
    if len(others) > 1:
        raise Problem(
            "More than two meshes are selected: select the sound one first, and the distorted last"
        )
    if others:
        return [item, *others]
    shape_keys.require_pose_active(item)
    return [item]
