"""A mesh as it moves in the scene, whatever moves it."""

from contextlib import contextmanager

from . import modifiers
from .poses import Poses, poses_of_seen, require_object_mode, seen_mesh
from .problem import Problem


def range_of(scene) -> tuple:
    """The first and the last frame that are played."""
    if scene.use_preview_range:
        return scene.frame_preview_start, scene.frame_preview_end
    return scene.frame_start, scene.frame_end


def frames_of(scene, step: int) -> list:
    """Numbers of the frames that are played: every n-th, and the last."""
    first, last = range_of(scene)
    return [*range(first, last, step), last]


def motion_of(context, item, step: int) -> tuple:
    """The object's vertices in the scene while it moves, without what modifiers add, and the
    numbers of the frames. Raises a Problem if it stands still."""
    require_object_mode(item)
    scene = context.scene
    frames = frames_of(scene, step)
    with _without_added(item), _frame_kept(scene):
        meshes = [_seen(context, item, frame) for frame in frames]
    poses = poses_of_seen([f"frame {frame}" for frame in frames], meshes)
    moved = [k for k in range(1, len(frames)) if (poses.shapes[k] != poses.shapes[k - 1]).any()]
    if not moved:
        raise Problem(
            f"'{item.name}' does not move from frame {frames[0]} to {frames[-1]}: make in-betweens,"
            " or set the scene's range to frames in which it moves"
        )
    part = slice(moved[0] - 1, moved[-1] + 1)
    kept = Poses(
        poses.names[part], poses.shapes[part], poses.own[part], poses.topology, poses.frame
    )
    return kept, frames[part]


def _seen(context, item, frame: int) -> tuple:
    context.scene.frame_set(frame)
    return seen_mesh(context, item)


@contextmanager
def _without_added(item):
    """Turns off the modifiers from the first one that changes which vertices there are."""
    kept = modifiers.moving(item)
    added = [m for m in item.modifiers if m.show_viewport and m.name not in kept]
    for modifier in added:
        modifier.show_viewport = False
    try:
        yield
    finally:
        for modifier in added:
            modifier.show_viewport = True


@contextmanager
def _frame_kept(scene):
    frame, subframe = scene.frame_current, scene.frame_subframe
    try:
        yield
    finally:
        scene.frame_set(frame, subframe=subframe)
