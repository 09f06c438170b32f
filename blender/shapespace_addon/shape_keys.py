"""Motions as shape keys with keyframes."""

import numpy as np

from . import animation, record
from .problem import Problem

_PREFIX = "geo"  # of the in-betweens' names


def require_editable(item) -> None:
    """Raises a Problem unless shape keys can be added to the object and be animated."""
    shape_keys = item.data.shape_keys
    parts = [item, item.data, shape_keys]
    if shape_keys is not None:
        if shape_keys.animation_data is not None:
            parts.append(shape_keys.animation_data.action)
        if not shape_keys.use_relative:
            raise Problem(f"The shape keys of '{item.name}' are absolute: tick Relative above them")
    for part in parts:
        if part is not None and part.library is not None:
            raise Problem(
                f"'{item.name}' is linked from another file: make it local first (Object >"
                " Relations > Make Local > Selected Objects and Data)"
            )


def require_free(item, names: list) -> None:
    """Raises a Problem unless these keys can be animated."""
    blocks = item.data.shape_keys.key_blocks
    for name in names:
        if blocks[name] != item.data.shape_keys.reference_key:
            animation.require_free(blocks[name])


def add_poses(item, names: list, shapes) -> list:
    """Gives an object these shapes as shape keys, and returns the names of the keys."""
    return [_add(item, name, shape).name for name, shape in zip(names, shapes)]


def add_motion(item, shapes: np.ndarray, poses: dict, timing, transferred=()) -> list:
    """Shape keys for the shapes of a motion that are no poses, and keyframes for all.

    `poses` has the names of the keys of those that are; a key may be there twice. What an earlier
    run added is replaced; poses that were transferred stay, unless these are others. Returns what
    is worth saying.
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
    for name in dict.fromkeys(name for _, name in shown):
        if animation.remove_keyframes(blocks[name]) and not earlier:
            replaced.append(f"'{name}'")
    for index, name in shown:
        animation.peak(blocks[name], index, len(shapes), timing.start, timing.step)
    record.write(
        shape_keys, list(made.values()), list(transferred) or record.transferred(shape_keys)
    )
    item.show_only_shape_key = False
    return [f"Keyframes that {', '.join(replaced)} had were replaced"] if replaced else []


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
