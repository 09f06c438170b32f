"""Markers of Fit To: vertex groups of one vertex, which have the same name in both bodies."""

import re

from .problem import Problem
from .vertex_groups import LEAST

# With which their names begin, so that no group of another use is taken for one.
PREFIX = "fit marker"


def pairs_of(context, template, target) -> tuple:
    """The vertices of the markers that both objects have: a pair for each, by its name, of numbers
    that vertices have in the meshes as they are seen. And what is worth saying about the others."""
    first, second = (_vertices(context, item) for item in (template, target))
    pairs = {name: (first[name], second[name]) for name in first if name in second}
    for side, item in enumerate((template, target)):
        _require_apart(item, {name: pair[side] for name, pair in pairs.items()})
    # No errors, because a template may be fitted onto several bodies, each with markers of its own.
    notes = []
    for item, own, other, others in (
        (template, first, target, second),
        (target, second, template, first),
    ):
        alone = ", ".join(f"'{name}'" for name in own if name not in others)
        if alone:
            notes.append(
                f"Of the markers of '{item.name}', {alone} had no effect, because '{other.name}'"
                " has no vertex in vertex groups of these names"
            )
    return pairs, notes


def with_names(text: str, names: list) -> str:
    """What an engine says, with the names of markers in place of their numbers. Numbers beyond the
    names are of markers that it has found."""

    def name(found) -> str:
        number = int(found[1])
        return f"'{names[number - 1]}'" if number <= len(names) else found[0]

    return re.sub(r"\bmarker (\d+)\b", name, text)


def _vertices(context, item) -> dict:
    """The vertex of each marker of an object by its name. A group without vertices is no marker:
    Undo in Edit Mode leaves it."""
    marked = _members(item, item.data.vertices)
    for name, members in marked.items():
        if len(members) > 1:
            raise Problem(
                f"{len(members)} vertices of '{item.name}' are in the vertex group '{name}', but"
                " a marker has one: remove the others from the group in Edit Mode, or delete the"
                " group"
            )
    if not marked:
        return {}
    evaluated = item.evaluated_get(context.evaluated_depsgraph_get())
    try:
        seen = _members(evaluated, evaluated.to_mesh().vertices)
    finally:
        evaluated.to_mesh_clear()
    for name in marked:
        if name not in seen:
            raise Problem(
                f"A modifier of '{item.name}' removes the vertex of the marker '{name}': turn the"
                " modifier off, or delete this vertex group"
            )
    # Modifiers that divide faces give weights to vertices near a marker, and those that copy a part
    # write the copy after the original: the first vertex of the greatest weight is the marked one.
    return {name: max(seen[name], key=seen[name].get) for name in marked}


def _members(item, vertices) -> dict:
    """For each marker that has vertices, by its name, the weights of these by their numbers."""
    marked = [group for group in item.vertex_groups if group.name.startswith(PREFIX)]
    weights = {group.index: {} for group in marked}
    for vertex in vertices if marked else ():
        for of in vertex.groups:
            if of.group in weights and of.weight >= LEAST:
                weights[of.group][vertex.index] = of.weight
    return {group.name: weights[group.index] for group in marked if weights[group.index]}


def _require_apart(item, vertices: dict) -> None:
    """Raises a Problem if two markers are on one vertex."""
    seen = {}
    for name, vertex in vertices.items():
        if vertex in seen:
            raise Problem(
                f"The markers '{seen[vertex]}' and '{name}' of '{item.name}' are on the same"
                " vertex: delete one of these vertex groups"
            )
        seen[vertex] = name
