"""Motions as shape keys with keyframes."""

from dataclasses import dataclass

import numpy as np

from . import animation, mesh_cache, record
from .problem import Problem

_PREFIX = "geo"  # of the in-betweens' names


def require_editable(item) -> None:
    """Raises a Problem unless shape keys can be added to the object and be animated."""
    shape_keys = item.data.shape_keys
    parts = [item.data, shape_keys]
    if shape_keys is not None:
        if shape_keys.animation_data is not None:
            parts.append(shape_keys.animation_data.action)
        if not shape_keys.use_relative:
            raise Problem(f"The shape keys of '{item.name}' are absolute: tick Relative above them")
    if item.library is not None or any(map(_is_of_another_file, parts)):
        raise Problem(
            f"The mesh of '{item.name}' is in another file, so that Blender would not save shape keys"
            " that are added here. A motion can be a Mesh Cache instead (Result), which library"
            " overrides can have. For shape keys, make the object local (Object > Relations > Make"
            " Local > Selected Objects and Data)"
        )


def _is_of_another_file(part) -> bool:
    """Whether a data-block, which may be None, is linked or is an override of one that is."""
    return part is not None and (part.library is not None or part.override_library is not None)


def require_free(item, names: list) -> None:
    """Raises a Problem unless these keys can be animated. Those with drivers need not be."""
    left = [item.data.shape_keys.reference_key.name, *driven(item, names)]
    for name in names:
        if name not in left:
            animation.require_free(item.data.shape_keys.key_blocks[name])


def driven(item, names) -> list:
    """Those of these keys whose values drivers decide on."""
    blocks = item.data.shape_keys.key_blocks
    return [name for name in names if animation.has_driver(blocks[name])]


def add_poses(item, names: list, shapes) -> list:
    """Gives an object these shapes as shape keys, and returns the names of the keys."""
    return [_add(item, name, shape).name for name, shape in zip(names, shapes)]


def add_motion(
    item, shapes: np.ndarray, poses: dict, timing, transferred=(), unseen=()
) -> list:
    """Shape keys for the shapes of a motion that are no poses, and keyframes for all.

    `poses` has the names of the keys of those that are; a key may be there twice. Keys that are
    `unseen` are off all the time. No key among them has a driver. What an earlier run added is
    replaced; poses that were transferred stay, unless these are others. Returns what is worth
    saying.
    """
    shape_keys = item.data.shape_keys
    blocks = shape_keys.key_blocks
    basis = shape_keys.reference_key.name
    earlier = record.in_betweens(shape_keys) or record.transferred(shape_keys)
    remove(item, record.in_betweens(shape_keys))
    made = {
        index: _add(item, f"{_PREFIX} {index:03d}", shape).name
        for index, shape in enumerate(shapes)
        if index not in poses
    }
    shown = [(index, name) for index, name in sorted({**poses, **made}.items()) if name != basis]
    replaced = []
    for name in dict.fromkeys([*(name for _, name in shown), *unseen]):
        if animation.remove_keyframes(blocks[name]) and not earlier:
            replaced.append(f"'{name}'")
    for index, name in shown:
        animation.peak(blocks[name], index, len(shapes), timing.start, timing.step)
    for name in unseen:
        blocks[name].value = 0
    record.write(
        shape_keys,
        in_betweens=list(made.values()),
        transferred=list(transferred) or record.transferred(shape_keys),
    )
    item.show_only_shape_key = False
    return [f"Keyframes that {', '.join(replaced)} had were replaced"] if replaced else []


def show_result(item, kind: str, shape: np.ndarray) -> None:
    """Gives an object one shape as a shape key that is on and active.

    The key of an earlier result of this kind is used again, unless it was renamed.
    """
    if item.data.shape_keys is None:
        item.shape_key_add(name="Basis", from_mix=False)
    shape_keys = item.data.shape_keys
    key = result_key(item, kind)
    if key is None:
        key = _add(item, kind, shape)
        record.write(shape_keys, **{kind: [key.name]})
    else:
        key.data.foreach_set("co", shape.astype(np.float32).reshape(-1))
    if not animation.has_keyframes(key):
        key.value = 1
    item.active_shape_key_index = shape_keys.key_blocks.find(key.name)
    item.data.update_tag()


def result_key(item, kind: str):
    """The key of an earlier result of this kind, or None."""
    shape_keys = item.data.shape_keys
    names = [] if shape_keys is None else record.made(shape_keys, kind)
    return next((shape_keys.key_blocks[n] for n in names if n in shape_keys.key_blocks), None)


def require_result_seen(item, kind: str) -> None:
    """Raises a Problem if a result of this kind could not be seen as a shape key."""
    require_editable(item)
    mesh_cache.require_none(item)
    key = result_key(item, kind)
    if key is not None and (key.mute or animation.has_driver(key)):
        raise Problem(
            f"The shape key '{key.name}' is muted or has a driver: change that, or rename the key to"
            " keep it"
        )


@dataclass
class Before:
    """What `show_result` changes, as it was."""

    had_keys: bool
    active: int
    shape: np.ndarray | None  # of the result's key, if there was one
    value: float


def state_before(item, kind: str) -> Before:
    key = result_key(item, kind)
    shape = None
    if key is not None:
        shape = np.empty(3 * len(key.data), np.float32)
        key.data.foreach_get("co", shape)
    had_keys = item.data.shape_keys is not None
    return Before(had_keys, item.active_shape_key_index, shape, 0 if key is None else key.value)


def restore(item, kind: str, before: Before) -> None:
    """Takes back what `show_result` has done, as far as it is still there."""
    key = result_key(item, kind)
    if before.shape is not None:
        if key is not None and 3 * len(key.data) == len(before.shape):
            key.data.foreach_set("co", before.shape)
            key.value = before.value
    elif key is not None:
        record.write(item.data.shape_keys, **{kind: []})
        item.shape_key_remove(key)
        if not before.had_keys and len(item.data.shape_keys.key_blocks) == 1:
            item.shape_key_clear()
    item.active_shape_key_index = before.active
    item.data.update_tag()


def require_pose_active(item) -> None:
    """Raises a Problem unless the active shape key is another one than the Basis."""
    keys = item.data.shape_keys
    if keys is None or item.active_shape_key == keys.reference_key:
        raise Problem(
            f"The active shape key of '{item.name}' is no distorted pose: choose one in the list of"
            " shape keys, or select a sound mesh first and then the distorted one"
        )
    if not keys.use_relative:
        raise Problem(f"The shape keys of '{item.name}' are absolute: tick Relative above them")


def turn_off(item, name: str) -> None:
    """Sets the value of a key of this name to 0, if there is one that has no keyframes."""
    keys = item.data.shape_keys
    key = None if keys is None else keys.key_blocks.get(name)
    if key is not None and key != keys.reference_key and not animation.has_keyframes(key):
        key.value = 0


def remove(item, names) -> None:
    """Removes shape keys, as far as they are there, and their keyframes."""
    blocks = item.data.shape_keys.key_blocks
    for name in names:
        if name in blocks:
            animation.remove_keyframes(blocks[name])
            item.shape_key_remove(blocks[name])


def _add(item, name: str, shape: np.ndarray):
    key = item.shape_key_add(name=name, from_mix=False)
    key.value = 0
    key.data.foreach_set("co", shape.astype(np.float32).reshape(-1))
    return key
