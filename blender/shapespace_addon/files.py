"""The two kinds of file that are exchanged with the tools: PLY, and point caches."""

import os
import re
import secrets
import struct

import numpy as np

from .problem import Problem

_PC2 = struct.Struct("<12siiffi")  # name, version, points, first frame, frames a sample, samples


def write_ply(file: str, vertices: np.ndarray, topology) -> None:
    """Binary, with coordinates as doubles."""
    segments = topology.segments
    header = [
        "ply",
        "format binary_little_endian 1.0",
        f"element vertex {len(vertices)}",
        *(f"property double {axis}" for axis in "xyz"),
        f"element face {topology.faces}",
        "property list int int vertex_indices",
    ]
    if len(segments):
        header += [f"element edge {len(segments)}", "property int vertex1", "property int vertex2"]
    header += ["end_header", ""]
    # Each face is its number of corners and then these.
    counts = topology.corners_of_faces
    starts = np.cumsum(counts) - counts + np.arange(len(counts))
    faces = np.empty(len(counts) + len(topology.corners), "<i4")
    is_corner = np.ones(len(faces), bool)
    is_corner[starts] = False
    faces[starts] = counts
    faces[is_corner] = topology.corners
    with open(file, "wb") as out:
        out.write("\n".join(header).encode())
        out.write(np.ascontiguousarray(vertices, "<f8").tobytes())
        out.write(faces.tobytes())
        out.write(np.ascontiguousarray(segments, "<i4").tobytes())


def read_shapes(file: str) -> np.ndarray:
    """The shapes in a file that a tool has written, k x n x 3: those of a point cache, or the one of
    a mesh."""
    return read_pc2(file) if file.endswith(".pc2") else _read_ply(file)[np.newaxis]


def _read_ply(file: str) -> np.ndarray:
    """The vertices of a mesh that a tool has made of one of `write_ply`: these come first, and have
    coordinates as doubles."""
    with open(file, "rb") as source:
        header, _, data = source.read().partition(b"end_header\n")
    points = int(re.search(rb"^element vertex (\d+)$", header, re.M)[1])
    return np.frombuffer(data, "<f8", count=3 * points).reshape(points, 3).astype(np.float64)


def read_pc2(file: str) -> np.ndarray:
    """The shapes of a point cache, k x n x 3."""
    with open(file, "rb") as source:
        data = source.read()
    magic, version, points, _, _, samples = _PC2.unpack_from(data)
    if magic != b"POINTCACHE2\0" or version != 1:
        raise Problem(f"{file} is no point cache of version 1")
    values = np.frombuffer(data, "<f4", count=3 * points * samples, offset=_PC2.size)
    return values.reshape(samples, points, 3).astype(np.float64)


def write_pc2(file: str, shapes: np.ndarray) -> None:
    """Writes under another name and then renames, so that no incomplete file is ever seen."""
    samples, points, _ = shapes.shape
    # The name is random, so that nobody can put a link there that leads to another file.
    unfinished = f"{file}.part{secrets.token_hex(8)}"
    try:
        os.makedirs(os.path.dirname(file), exist_ok=True)
        try:
            with open(unfinished, "xb") as out:
                out.write(_PC2.pack(b"POINTCACHE2\0", 1, points, 0.0, 1.0, samples))
                out.write(shapes.astype("<f4").tobytes())
            os.replace(unfinished, file)
        finally:
            if os.path.exists(unfinished):
                os.remove(unfinished)
    except OSError as error:
        raise Problem(
            f"{file} cannot be written: {error.strerror}; choose another folder for caches"
        ) from None
