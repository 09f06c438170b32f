"""Poses, as a scene has them: shape keys of one object, or several objects."""

import re
from dataclasses import dataclass

import numpy as np

from . import record, vertex_groups
from .frame import Frame
from .problem import Problem
from .topology import Topology, require_same, topology_of


@dataclass
class Poses:
    """Poses of one mesh as arrays, in the form that the engines take."""

    names: list
    shapes: list  # n x 3 each, in scene coordinates of `frame`
    own: list  # n x 3 each, in coordinates of the pose's object
    topology: Topology
    frame: Frame  # of the first pose's object

    def same(self, other: "Poses") -> bool:
        """Whether names, positions within the objects and polygons are equal."""
        return (
            self.names == other.names
            and all(map(np.array_equal, self.own, other.own))
            and np.array_equal(self.topology.corners, other.topology.corners)
        )


def selected_meshes(context) -> list:
    """The selected meshes, or else the active one."""
    meshes = [item for item in context.selected_objects if item.type == "MESH"]
    active = context.active_object
    if not meshes and active is not None and active.type == "MESH":
        meshes = [active]
    if not meshes:
        raise Problem(
            "No mesh is selected: select one with shape keys, or several that are poses of one mesh"
        )
    return sorted(meshes, key=lambda item: _natural(item.name))


def require_poses(context) -> None:
    """Raises a Problem if it can be seen at once that there are no poses."""
    items = selected_meshes(context)
    for item in items:
        require_object_mode(item)
    if len(items) == 1:
        require_shape_keys(items[0])


def require_object_mode(item) -> None:
    if item.mode != "OBJECT":
        mode = item.mode.replace("_", " ").title()
        raise Problem(f"'{item.name}' is in {mode} Mode: change to Object Mode first")


def active_mesh(context):
    """The active object. Raises a Problem unless it is a mesh in Object Mode."""
    item = context.active_object
    if item is None or item.type != "MESH":
        raise Problem("The active object is no mesh: make a mesh active, by a click on it")
    require_object_mode(item)
    return item


def require_shape_keys(item) -> None:
    shape_keys = item.data.shape_keys
    if shape_keys is None:
        raise Problem(
            f"'{item.name}' has no shape keys: add one for each pose, or select several meshes"
            " that are poses of one"
        )
    if not shape_keys.use_relative:
        raise Problem(f"The shape keys of '{item.name}' are absolute: tick Relative above them")


def poses_of_keys(context, item, with_basis: bool) -> Poses:
    """The shapes of an object's shape keys, each at value 1 while all others are 0.

    Muted keys are no poses, and neither are in-betweens of an earlier run.
    """
    require_object_mode(item)
    _require_vertices(item.name, item.data)
    require_shape_keys(item)
    shape_keys = item.data.shape_keys
    made = set(record.in_betweens(shape_keys))
    basis = shape_keys.reference_key
    keys = [
        key
        for key in shape_keys.key_blocks
        if key.name not in made and (with_basis if key == basis else not key.mute)
    ]
    if len(keys) < 2:
        only = f"one pose only, '{keys[0].name}'" if keys else "no pose"
        raise Problem(f"'{item.name}' has {only}: add shape keys, or unmute those that are muted")
    return _poses(
        [key.name for key in keys],
        [_shape_of_key(item, key) for key in keys],
        [matrix_of(context, item)] * len(keys),
        topology_of(item.data),
    )


def poses_of_objects(context, items) -> Poses:
    """Objects as they are seen, that is, with their modifiers, and where they stand."""
    for item in items:
        require_object_mode(item)
    names = [item.name for item in items]
    meshes = [seen_mesh(context, item) for item in items]
    for name, (_, _, matrix) in zip(names, meshes):
        _require_same_side(names[0], meshes[0][2], name, matrix)
    return poses_of_seen(names, meshes)


def seen_mesh(context, item) -> tuple:
    """An object as it is seen, that is, with its modifiers: vertices, topology and matrix."""
    evaluated = item.evaluated_get(context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    try:
        _require_vertices(item.name, mesh)
        return _coordinates(mesh.vertices), topology_of(mesh), matrix_of(context, item)
    finally:
        evaluated.to_mesh_clear()


def poses_of_seen(names: list, meshes: list) -> Poses:
    """Poses of what `seen_mesh` returns. Raises a Problem unless all have the same faces."""
    shapes, topologies, matrices = zip(*meshes)
    for name, topology in zip(names, topologies):
        require_same(topologies[0], names[0], topology, name)
    return _poses(names, shapes, matrices, topologies[0])


def pose_of_target(context, item) -> Poses:
    """A body at rest: the Basis of an object that has shape keys, else its mesh."""
    require_object_mode(item)
    _require_vertices(item.name, item.data)
    shape_keys = item.data.shape_keys
    points = item.data.vertices if shape_keys is None else shape_keys.reference_key.data
    return _poses(
        [item.name], [_coordinates(points)], [matrix_of(context, item)], topology_of(item.data)
    )


def template_and_target(context, template, target) -> list:
    """Two bodies of any faces, each as `poses_of_objects` has it."""
    found = [poses_of_objects(context, [item]) for item in (template, target)]
    _require_same_side(
        template.name, found[0].frame.matrix, target.name, found[1].frame.matrix
    )
    return found


def distorted_and_sound(context, item, other) -> Poses:
    """The active shape key of an object and its Basis or, with another object, that one's mesh at
    rest; then the object may have no shape keys."""
    require_object_mode(item)
    _require_vertices(item.name, item.data)
    shape_keys = item.data.shape_keys
    topology = topology_of(item.data)
    key = item.active_shape_key
    if shape_keys is None or (other is not None and key == shape_keys.reference_key):
        name, distorted = item.name, pose_of_target(context, item).own[0]
    else:
        name, distorted = key.name, _shape_of_key(item, key)
    matrix = matrix_of(context, item)
    if other is None:
        reference = shape_keys.reference_key
        names, sound = [name, reference.name], _coordinates(reference.data)
        return _poses(names, [distorted, sound], [matrix] * 2, topology)
    body = pose_of_target(context, other)
    require_same(topology, item.name, body.topology, other.name)
    _require_same_side(item.name, matrix, other.name, body.frame.matrix)
    return _poses(
        [name, other.name], [distorted, body.own[0]], [matrix, body.frame.matrix], topology
    )


def _require_same_side(first: str, matrix: np.ndarray, other: str, matrix_of_other) -> None:
    if np.linalg.det(matrix[:3, :3]) * np.linalg.det(matrix_of_other[:3, :3]) < 0:
        raise Problem(
            f"Either '{first}' or '{other}' is mirrored, since its scale is negative: give both a"
            " positive scale"
        )


def _require_vertices(name: str, mesh) -> None:
    """Shape keys without points have arbitrary numbers of them in Blender 4.3."""
    if not mesh.vertices:
        raise Problem(f"'{name}' has no vertices: add a mesh to it")


def _poses(names, own, matrices, topology) -> Poses:
    for name, shape in zip(names, own):
        wrong = np.flatnonzero(~np.isfinite(shape).all(axis=1))
        if len(wrong):
            raise Problem(f"Vertex {wrong[0]} of '{name}' is at no finite place: move or delete it")
    centre = Frame(matrices[0]).to_scene(own[0]).mean(axis=0)
    frames = [Frame(matrix, centre) for matrix in matrices]
    shapes = [frame.to_scene(shape) for frame, shape in zip(frames, own)]
    return Poses(names, shapes, own, topology, frames[0])


def _shape_of_key(item, key) -> np.ndarray:
    basis = item.data.shape_keys.reference_key
    shape = _coordinates(key.data)
    if key == basis:
        return shape
    offsets = shape - _coordinates(key.relative_key.data)
    if key.vertex_group in item.vertex_groups:
        weights = vertex_groups.weights(item, key.vertex_group, item.data.vertices, "limits a key")
        offsets *= weights[:, np.newaxis]
    return _coordinates(basis.data) + offsets


def _coordinates(points) -> np.ndarray:
    flat = np.empty(3 * len(points), np.float32)
    points.foreach_get("co", flat)
    return flat.reshape(-1, 3).astype(np.float64)


def matrix_of(context, item) -> np.ndarray:
    """The object's matrix in the scene, 4 x 4. Raises a Problem unless it can be inverted."""
    evaluated = item.evaluated_get(context.evaluated_depsgraph_get())
    matrix = np.array(evaluated.matrix_world, np.float64)
    lengths = np.linalg.norm(matrix[:3, :3], axis=0)
    if not abs(np.linalg.det(matrix[:3, :3])) > 1e-9 * np.prod(lengths):
        raise Problem(
            f"'{item.name}' is scaled to zero along some direction: give it another scale"
        )
    return matrix


def _natural(name: str) -> list:
    """So that 'pose 2' comes before 'pose 10'."""
    return [int(part) if part.isdecimal() else part.lower() for part in re.split(r"(\d+)", name)]
