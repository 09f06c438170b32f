"""Motions as point caches, which a modifier plays."""

import os

import bpy

from . import modifiers
from .files import write_pc2
from .problem import Problem

_MODIFIER = "shapespace"
_NOT_IN_FILE_NAMES = '/\\:*?"<>|'  # of some system


def file_for(item_name: str, folder: str) -> str:
    """The cache of an object. Its name begins with that of the .blend, since scenes in one folder
    may have objects of one name. Raises a Problem if it cannot be written there."""
    if folder.startswith("//") and not bpy.data.filepath:
        raise Problem(
            "The point cache belongs beside the .blend, which is not saved yet: save it, or choose"
            " a folder for caches"
        )
    scene = os.path.splitext(bpy.path.basename(bpy.data.filepath))[0]
    name = _as_file_name("-".join(filter(None, (scene, item_name))))
    where = os.path.abspath(bpy.path.abspath(folder))
    existing = where
    # The root of a Windows drive may be missing, and it is its own parent.
    while not os.path.exists(existing) and existing != os.path.dirname(existing):
        existing = os.path.dirname(existing)
    if not os.path.isdir(existing) or not os.access(existing, os.W_OK):
        raise Problem(f"Nothing can be written to {where}: choose another folder for caches")
    return os.path.join(where, name + ".pc2")


def _as_file_name(name: str) -> str:
    """The name, with signs that names of files cannot have encoded as in web addresses, so that
    different names remain different."""
    return "".join(
        f"%{ord(sign):02X}" if sign in _NOT_IN_FILE_NAMES + "%" or sign < " " else sign
        for sign in name
    )


def require_editable(item) -> None:
    """Raises a Problem unless the object can be given a modifier that is saved."""
    override = item.override_library
    if item.library is not None or (override is not None and override.is_system_override):
        raise Problem(
            f"'{item.name}' is linked from another file: make a library override of it, which can be"
            " edited (Object > Library Override > Make), or make it local (Object > Relations > Make"
            " Local > Selected Objects)"
        )


def add_motion(context, item, shapes, file: str, timing) -> None:
    """Writes the cache, and gives the object a modifier that plays it, before all others.

    The modifier of an earlier run is used again.
    """
    write_pc2(file, shapes)
    modifier = _modifier(item)
    if modifier is None:
        modifier = modifiers.add_first(context, item, _MODIFIER, "MESH_CACHE")
    modifier.cache_format = "PC2"
    modifier.filepath = bpy.path.relpath(file) if bpy.data.filepath else file
    # The cache's shape at a frame is its number `frame * frame_scale - frame_start`.
    modifier.frame_scale = 1 / timing.step
    modifier.frame_start = timing.start / timing.step


def require_none(item) -> None:
    """Raises a Problem if a cache that is seen hides the shape keys."""
    modifier = _modifier(item)
    if modifier is not None and modifier.show_viewport:
        raise Problem(
            f"The modifier '{modifier.name}' of '{item.name}' plays a point cache, which hides shape"
            " keys: turn it off, or remove it"
        )


def remove(item) -> None:
    """Removes the modifier of an earlier run, which would hide shape keys."""
    modifier = _modifier(item)
    if modifier is not None:
        item.modifiers.remove(modifier)


def _modifier(item):
    modifier = item.modifiers.get(_MODIFIER)
    return modifier if modifier is not None and modifier.type == "MESH_CACHE" else None
