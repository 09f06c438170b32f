"""Bones and weights that reproduce a motion."""

import json
import pickle
import struct

import numpy as np
import pytest

import shapespace as ss


@pytest.fixture(scope="module")
def skinning(path):
    return path.skin(bones=6, weights_per_vertex=3)


def blended(skinning):
    """Linear blend skinning of the arrays, k x n x 3."""
    rest = np.c_[skinning.rest, np.ones(len(skinning.rest))]
    moved = np.einsum("ibrc,nc->ibnr", skinning.transforms, rest)[..., :3]
    return np.einsum("nb,ibnr->inr", skinning.weight_matrix(), moved)


def test_the_arrays_make_the_shapes(skinning, path):
    np.testing.assert_allclose(blended(skinning), skinning.vertices, atol=1e-12)
    np.testing.assert_array_equal(skinning[-1], skinning.vertices[-1])
    np.testing.assert_array_equal(skinning.rest, path[0])
    np.testing.assert_array_equal(skinning.faces, path.faces)
    assert len(skinning) == len(path) and len(list(skinning)) == len(path)
    with pytest.raises(IndexError):
        skinning[len(path)]


def test_weights_and_the_tree_are_as_engines_have_them(skinning):
    joints, n = skinning.summary.bones, len(skinning.rest)
    assert skinning.bones.shape == skinning.weights.shape == (n, 3)
    assert skinning.weights.min() >= 0 and np.all(np.diff(skinning.weights, axis=1) <= 0)
    np.testing.assert_allclose(skinning.weights.sum(axis=1), 1, atol=1e-9)
    dense = skinning.weight_matrix()
    assert dense.shape == (n, joints)
    np.testing.assert_array_equal(
        np.take_along_axis(dense, skinning.bones, axis=1)[:, 0], skinning.weights[:, 0]
    )
    assert skinning.parents[0] == -1 and np.all(skinning.parents < np.arange(joints))
    assert len(skinning.names) == joints and skinning.pivots.shape == (joints, 3)


def test_errors_are_those_of_the_shapes(skinning, path):
    squares = ((skinning.vertices - path.vertices) ** 2).sum(axis=-1)
    np.testing.assert_allclose(skinning.vertex_errors, np.sqrt(squares.mean(axis=0)), atol=1e-9)
    np.testing.assert_allclose(skinning.shape_errors, np.sqrt(squares.mean(axis=1)), atol=1e-9)
    summary = skinning.summary
    np.testing.assert_allclose(summary.error, np.sqrt(squares.mean()), rtol=1e-9)
    assert np.sqrt(squares[summary.max_error_shape, summary.max_error_vertex]) == pytest.approx(
        summary.max_error
    )
    assert summary.converged and summary.to_dict()["bones"] == 6


def test_frames_need_not_be_a_path(path, poses, animal):
    """Those of a capture, say; they stay where they are."""
    frames = path.vertices + [10, 0, 0]
    of_frames = ss.skin(frames, animal.faces, bones=6)
    of_path = path.skin(6)
    np.testing.assert_allclose(of_frames.vertices, of_path.vertices + [10, 0, 0], atol=1e-6)
    together = ss.skin(path.vertices, animal, bones=6)
    one_by_one = ss.skin(*path.vertices, animal.faces, bones=6)
    np.testing.assert_array_equal(one_by_one.vertices, together.vertices)
    assert len(ss.skin(ss.Poses(poses, animal), bones=2)) == 2


def test_as_few_bones_as_an_error_needs(path):
    found = path.skin("auto", error=0.02)
    assert found.summary.relative_error <= 0.02 < path.skin(1).summary.relative_error
    finer = path.skin("auto", error=0.005)
    assert finer.summary.bones > found.summary.bones
    with pytest.warns(UserWarning, match="most that are permitted"):
        assert path.skin("auto", error=0.001, most_bones=2).summary.bones == 2


@pytest.mark.parametrize(
    "options, words",
    [
        ({"bones": 0}, "bones: "),
        ({"bones": 501}, "bones: "),
        ({"bones": 2.5}, "bones: must be int"),
        ({"bones": 3, "error": 0.1}, "error: goes with bones='auto'"),
        ({"weights_per_vertex": 9}, "weights_per_vertex: "),
        ({"rest": 99}, "rest: "),
        ({"bnes": 3}, "did you mean 'bones'"),
    ],
)
def test_what_cannot_be_is_refused_by_name(path, options, words):
    with pytest.raises((ValueError, TypeError), match=words):
        path.skin(**options)


def test_one_shape_has_no_motion(poses, animal):
    with pytest.raises(ss.MeshError, match="two shapes or more"):
        ss.skin(poses[:1], animal.faces)


def glb(file):
    content = file.read_bytes()
    (length,) = struct.unpack("<I", content[12:16])
    return json.loads(content[20 : 20 + length])


def test_a_glb_has_the_skeleton(skinning, tmp_path):
    skinning.write(tmp_path / "walk.glb", duration=2, key_error=0)
    described = glb(tmp_path / "walk.glb")
    assert len(described["skins"][0]["joints"]) == skinning.summary.bones
    times = described["animations"][0]["samplers"][0]["input"]
    assert described["accessors"][times]["max"] == [2]
    with pytest.raises(ss.FileError, match="glb"):
        skinning.write(tmp_path / "walk.usda")
    with pytest.raises(TypeError, match="did you mean 'duration'"):
        skinning.write(tmp_path / "walk.glb", durations=2)
    with pytest.raises(ss.InvalidOptions, match="key_error"):
        skinning.write(tmp_path / "walk.glb", key_error=1)


def test_a_skinning_is_pickled(skinning, path, tmp_path):
    stretched = path.skin(4, scale=True)
    for one in (skinning, stretched):
        again = pickle.loads(pickle.dumps(one))
        for name in ("vertices", "transforms", "bones", "weights", "pivots", "parents"):
            np.testing.assert_array_equal(getattr(again, name), getattr(one, name))
        np.testing.assert_array_equal(again.vertex_errors, one.vertex_errors)
        np.testing.assert_array_equal(again.shape_errors, one.shape_errors)
        assert repr(again) == repr(one) and again.summary.to_dict() == one.summary.to_dict()
        one.write(tmp_path / "one.glb")
        again.write(tmp_path / "again.glb")
        assert (tmp_path / "one.glb").read_bytes() == (tmp_path / "again.glb").read_bytes()
