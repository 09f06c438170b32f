"""Spaces of poses, their plane, and the parts that they are made of."""

import json

import numpy as np
import pytest

import shapespace as ss


@pytest.fixture(scope="module")
def space():
    body = ss.skinned_body("quadruped", 500)
    poses = [body.pose(name) for name in ("stand", "stride", "sit", "stretch")]
    names = ["stand", "stride", "sit", "stretch"]
    return ss.explore(poses, body, names=names, depth=0, geodesic={"shapes": 1}).space


def test_many_points_have_the_shapes_of_each(space):
    middle = space.points.mean(axis=0)
    points = np.vstack([middle, space.points[2], middle + 100])
    shapes = space.at(points)
    for point, shape in zip(points, shapes):
        np.testing.assert_array_equal(space.at(point), shape)
    np.testing.assert_allclose(shapes[1], space[2], atol=1e-12)
    np.testing.assert_array_equal(space.contains(points), [True, True, False])
    assert space.contains(middle) is True and space.contains(points[2]) is False
    for bad in ([1, 2, 3], [[1, 2, 3]], 4):
        with pytest.raises(ValueError, match="points"):
            space.at(bad)


def test_points_whose_distances_fit_a_plane_are_found_again():
    points = np.array([[0.0, 0], [3, 0], [0, 2], [2, 2], [1, 1]])
    distances = np.linalg.norm(points[:, None] - points[None], axis=2)
    found, stress, converged = ss.embed(distances)
    assert converged and stress < 1e-6
    again = np.linalg.norm(found[:, None] - found[None], axis=2)
    np.testing.assert_allclose(again, distances, atol=1e-5)
    with pytest.raises(ss.InvalidOptions, match="distances"):
        ss.embed(distances[:, :3])
    with pytest.raises(ValueError, match="distances: must be a two-dimensional"):
        ss.embed(distances[0])


def test_triangles_of_the_plane_cover_the_hull():
    points = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.4]])
    triangles = ss.triangulate(points)
    (a, b), (c, d) = (
        (points[triangles[:, k]] - points[triangles[:, 0]]).T for k in (1, 2)
    )
    areas = (a * d - b * c) / 2
    assert (areas > 0).all()
    np.testing.assert_allclose(areas.sum(), 1)
    assert len(ss.triangulate(points[:1] + [[0, 0], [1, 1], [2, 2]])) == 0


def test_blends_are_measured(space):
    errors = ss.measure_blends(space, 5, geodesic={"shapes": 1})
    assert 0 < errors.mean <= errors.max and 0 <= errors.within <= 1
    with pytest.raises(TypeError, match="space: must be a Space"):
        ss.measure_blends(space.points)


def test_a_curve_is_read_for_a_walk(space, tmp_path):
    (tmp_path / "curve.json").write_text(json.dumps({"points": ["stand", [0, 0], "sit"]}))
    curve = ss.read_curve(tmp_path / "curve.json", space)
    np.testing.assert_array_equal(curve, [space.points[0], [0, 0], space.points[2]])
    walk = space.along(curve, 5)
    np.testing.assert_allclose(walk[0], space[0], atol=1e-12)
    np.testing.assert_allclose(walk[4], space[2], atol=1e-12)
