"""How the vertices of a mesh are connected."""

from dataclasses import dataclass

import numpy as np

from .problem import Problem


@dataclass
class Topology:
    """Faces and loose edges of a mesh."""

    vertices: int
    corners_of_faces: np.ndarray  # how many corners each face has
    corners: np.ndarray  # the vertices of one face after the other
    segments: np.ndarray  # k x 2: edges that belong to no face

    def polygons(self) -> list:
        """The vertices of each face, as lists."""
        ends = np.cumsum(self.corners_of_faces)[:-1]
        return [face.tolist() for face in np.split(self.corners, ends)] if self.faces else []

    @property
    def faces(self) -> int:
        return len(self.corners_of_faces)


def topology_of(mesh) -> Topology:
    corners_of_faces = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", corners_of_faces)
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    edges = np.empty((len(mesh.edges), 2), np.int32)
    mesh.edges.foreach_get("vertices", edges.reshape(-1))
    loose = np.empty(len(mesh.edges), bool)
    mesh.edges.foreach_get("is_loose", loose)
    return Topology(len(mesh.vertices), corners_of_faces, corners, edges[loose])


def require_same(first: Topology, first_name: str, other: Topology, other_name: str) -> None:
    """Raises a Problem unless both meshes have the same faces in the same order."""
    remedy = (
        "poses must be copies of one mesh, with vertices and faces in the same order. Fit To makes a"
        f" body with the faces of '{first_name}' and the shape of '{other_name}'"
    )
    for what in ("vertices", "faces"):
        numbers = getattr(first, what), getattr(other, what)
        if numbers[0] != numbers[1]:
            raise Problem(
                f"'{first_name}' has {numbers[0]} {what} and '{other_name}' {numbers[1]}: {remedy}"
            )
    for what in ("corners_of_faces", "corners", "segments"):
        if not np.array_equal(getattr(first, what), getattr(other, what)):
            raise Problem(
                f"The faces of '{other_name}' connect other vertices than those of"
                f" '{first_name}': {remedy}"
            )
