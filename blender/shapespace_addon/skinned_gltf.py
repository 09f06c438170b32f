"""Reads the skinned glTF that shape-export writes: joints in a tree, weights, and an animation in
which shape k of the motion is at the time k.

Blender's own importer cannot do this everywhere: that of Debian 12 fails on every file, for want of
the numpy that it was written for, and it gives bones other axes and frames.
"""

import json
import struct
from dataclasses import dataclass

import numpy as np
from mathutils import Quaternion

_TYPES = {5121: "<u1", 5123: "<u2", 5126: "<f4"}
_COLUMNS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


@dataclass
class Track:
    """One property of a joint in every shape, relative to its parent."""

    values: np.ndarray  # shapes x 3, or x 4 for rotations (w, x, y, z)
    keys: list  # the shapes between which it changes evenly


@dataclass
class Joint:
    name: str
    parent: int  # which comes earlier, or -1
    place: np.ndarray  # in the rest pose, relative to the parent
    turn: np.ndarray  # the same of its axes: w, x, y, z
    tracks: dict  # by the names "translation", "rotation" and "scale", as far as they change


@dataclass
class Skin:
    joints: list
    origin: np.ndarray  # of the coordinates of joints that have no parent
    bones: np.ndarray  # n x k, for each vertex the joints that move it
    weights: np.ndarray  # n x k, with sum 1


def read(file: str, vertices: int, shapes: int) -> Skin:
    """`vertices` are those of the poses, after which the file may have copies."""
    with open(file, "rb") as source:
        data = source.read()
    (size,) = struct.unpack_from("<I", data, 12)
    model = json.loads(data[20 : 20 + size])
    arrays = _Arrays(model, data, 28 + size)
    nodes = model["nodes"]
    joints = _joints(nodes, shapes)
    (animation,) = model["animations"]
    for channel in animation["channels"]:
        node, path = channel["target"]["node"], channel["target"]["path"]
        sampler = animation["samplers"][channel["sampler"]]
        times, values = arrays.read(sampler["input"])[:, 0], arrays.read(sampler["output"])
        joints[node].tracks[path] = _track(path, times, values, shapes)
    attributes = model["meshes"][0]["primitives"][0]["attributes"]
    sets = range(sum(name.startswith("JOINTS_") for name in attributes))
    bones = np.hstack([arrays.read(attributes[f"JOINTS_{i}"]) for i in sets])[:vertices]
    weights = np.hstack([arrays.read(attributes[f"WEIGHTS_{i}"]) for i in sets])[:vertices]
    order = list(joints)
    numbers = np.array([order.index(node) for node in model["skins"][0]["joints"]])
    return Skin(
        list(joints.values()),
        np.array(nodes[1]["translation"]),
        numbers[bones.astype(int)],
        weights / weights.sum(axis=1, keepdims=True),
    )


class _Arrays:
    def __init__(self, model: dict, data: bytes, begin: int):
        self._model = model
        self._data = data
        self._begin = begin

    def read(self, accessor: int) -> np.ndarray:
        entry = self._model["accessors"][accessor]
        view = self._model["bufferViews"][entry["bufferView"]]
        columns = _COLUMNS[entry["type"]]
        flat = np.frombuffer(
            self._data,
            _TYPES[entry["componentType"]],
            entry["count"] * columns,
            self._begin + view.get("byteOffset", 0),
        )
        return flat.reshape(-1, columns).astype(np.float64)


def _joints(nodes: list, shapes: int) -> dict:
    """By their nodes, parents first. Node 0 is the mesh, node 1 is above the root."""
    found = {}

    def add(node: int, parent: int) -> None:
        entry = nodes[node]
        x, y, z, w = entry.get("rotation", (0, 0, 0, 1))
        place = np.array(entry.get("translation", (0, 0, 0)), float)
        number = len(found)
        found[node] = Joint(entry["name"], parent, place, np.array((w, x, y, z), float), {})
        for child in entry.get("children", ()):
            add(child, number)

    for root in nodes[1]["children"]:
        add(root, -1)
    return found


def _track(path: str, times: np.ndarray, values: np.ndarray, shapes: int) -> Track:
    moments = np.arange(shapes)
    if path == "rotation":
        turns = [Quaternion((w, x, y, z)) for x, y, z, w in values]
        at = np.array([_turn_at(times, turns, moment) for moment in moments])
    else:
        at = np.stack([np.interp(moments, times, column) for column in values.T], axis=1)
    keys = {0, shapes - 1, *np.round(times).astype(int).tolist()}
    return Track(at, sorted(key for key in keys if key < shapes))


def _turn_at(times: np.ndarray, turns: list, moment: float):
    after = min(int(np.searchsorted(times, moment)), len(times) - 1)
    if after == 0 or times[after] <= moment:
        return turns[after]
    share = (moment - times[after - 1]) / (times[after] - times[after - 1])
    return turns[after - 1].slerp(turns[after], share)
