"""What is measured of meshes and paths, and files of vertices, fields and maps."""

import json

import numpy as np
import pytest

import shapespace as ss


def test_vertices_are_selected_as_in_files_of_handles(animal, poses):
    shape = poses[0]
    centre, radius = shape[5], 0.3
    ball = {"ball": {"centre": centre.tolist(), "radius": radius}}
    near = np.flatnonzero(np.linalg.norm(shape - centre, axis=1) <= radius)
    for selection in (ball, json.dumps(ball), {"any": [ball, {"vertices": [6]}]}):
        np.testing.assert_array_equal(ss.select(shape, animal, selection), near)
    with pytest.raises(ss.InvalidOptions, match="radius"):
        ss.select(shape, animal, {"ball": {"centre": [0, 0, 0], "radius": -1}})


def test_triangles_that_pass_through_each_other_are_counted():
    triangle = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    across = triangle[:, [0, 2, 1]] + [0.2, 0.2, -0.3]
    faces = [[0, 1, 2], [3, 4, 5]]
    shapes = [np.vstack([triangle, across]), np.vstack([triangle, across + 5])]
    np.testing.assert_array_equal(ss.intersections(shapes, faces), [1, 0])


def test_a_field_is_read_from_a_text_or_a_ply(tmp_path):
    (tmp_path / "stiff.txt").write_text("1\n2.5 # stiff\n4\n")
    np.testing.assert_array_equal(ss.read_vertex_field(tmp_path / "stiff.txt"), [1, 2.5, 4])
    (tmp_path / "a.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty float stiff\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n"
        "0 0 0 7\n1 0 0 8\n0 1 0 9\n3 0 1 2\n"
    )
    np.testing.assert_array_equal(ss.read_vertex_field(f"{tmp_path}/a.ply:stiff"), [7, 8, 9])


def test_the_energy_of_vertices_adds_up_to_the_path_s(path):
    density = path.vertex_energy()
    assert density.shape == path.vertices.shape[:2]
    speed = density @ path.metric.vertex_area
    # A geodesic has the speed of its length in unit time.
    length = np.sum(
        [path.metric.norm((b + a) / 2, b - a) for a, b in zip(path.vertices, path.vertices[1:])]
    )
    np.testing.assert_allclose(speed, length**2, rtol=0.1)


def test_rigid_parts_depend_on_what_is_tolerated(path):
    coarse, fine = (path.rigid_parts(tolerance=t) for t in (0.3, 0.02))
    assert coarse.max() < fine.max()
    assert (path.rigid_parts(least_share=0.2) < 0).sum() > (path.rigid_parts() < 0).sum()
    with pytest.raises(ss.InvalidOptions, match="tolerance"):
        path.rigid_parts(tolerance=-1)


def test_a_surface_map_is_read_as_it_was_written(animal, tmp_path):
    mesh = ss.Poses([animal.pose("stand")], animal)
    markers = np.arange(0, len(mesh[0]), 30)
    map = ss.correspond(mesh, mesh, np.stack([markers, markers], 1)).map
    map.write(tmp_path / "map.txt")
    again = ss.read_surface_map(tmp_path / "map.txt", mesh, mesh)
    np.testing.assert_array_equal(again.to_target.triangle, map.to_target.triangle)
    np.testing.assert_allclose(again.round_trip, map.round_trip, atol=1e-6)
    small = ss.Poses([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]], [[0, 1, 2]])
    with pytest.raises(ss.FileError, match="map.txt"):
        ss.read_surface_map(tmp_path / "map.txt", mesh, small)


def test_many_geodesics_share_a_metric(animal, poses):
    interpolator = ss.Interpolator(poses, animal, shapes=1)
    path, summary = interpolator.between(poses[1], poses[0])
    assert summary.converged and len(path) == 3
    again = ss.interpolate([poses[1], poses[0]], animal, metric=interpolator.metric, shapes=1).path
    np.testing.assert_allclose(path.vertices, again.vertices, atol=0.02)
    np.testing.assert_array_equal(
        interpolator.between(poses[1], poses[0]).path.vertices, path.vertices
    )
    with pytest.raises(ss.MeshError):
        interpolator.between(poses[0], poses[0][:-1])
