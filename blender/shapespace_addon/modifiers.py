"""Modifiers, and their order."""

import bpy

# Those that move vertices, and add and remove none.
_MOVING = {
    "ARMATURE", "CAST", "CLOTH", "CORRECTIVE_SMOOTH", "CURVE", "DISPLACE", "HOOK", "LAPLACIANDEFORM",
    "LAPLACIANSMOOTH", "LATTICE", "MESH_CACHE", "MESH_DEFORM", "MESH_SEQUENCE_CACHE", "SHRINKWRAP",
    "SIMPLE_DEFORM", "SMOOTH", "SOFT_BODY", "SURFACE_DEFORM", "WARP", "WAVE",
}  # fmt: skip


def moving(item) -> list:
    """Names of the modifiers that are on, up to the first that changes which vertices there are."""
    found = []
    for modifier in item.modifiers:
        if modifier.show_viewport:
            if modifier.type not in _MOVING:
                break
            found.append(modifier.name)
    return found


def add_first(context, item, name: str, kind: str):
    """Adds a modifier before all others."""
    modifier = item.modifiers.new(name, kind)
    if len(item.modifiers) > 1:
        with context.temp_override(object=item, active_object=item):
            bpy.ops.object.modifier_move_to_index(modifier=modifier.name, index=0)
    return modifier
