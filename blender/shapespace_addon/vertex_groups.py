"""Vertex groups as weights of vertices, and as sets of vertices."""

import numpy as np

from .problem import Problem

# Vertices of at least this weight belong to a set.
LEAST = 0.5


def weights(item, name: str, vertices, use: str) -> np.ndarray:
    """The weight of each of these vertices: of the object's mesh, or of the mesh as it is seen.

    Raises a Problem that says for which `use` the group is missing.
    """
    if name not in item.vertex_groups:
        raise Problem(
            f"'{item.name}' has no vertex group '{name}', which {use}: choose another"
        )
    group = item.vertex_groups[name].index
    return np.array(
        [next((of.weight for of in vertex.groups if of.group == group), 0.0) for vertex in vertices]
    )


def members(item, name: str, vertices, use: str) -> np.ndarray:
    """The numbers of the vertices of a group. Raises a Problem if there are none."""
    found = np.flatnonzero(weights(item, name, vertices, use) >= LEAST)
    if not len(found):
        raise Problem(
            f"No vertex of '{item.name}' has a weight of {LEAST} or more in the vertex group"
            f" '{name}', which {use}: assign vertices to it, or choose another"
        )
    return found
