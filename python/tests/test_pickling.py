"""Objects in other processes: everything that solvers take and return can be pickled."""

import multiprocessing
import pickle

import numpy as np
import pytest

import shapespace as ss


def copied(thing):
    return pickle.loads(pickle.dumps(thing))


@pytest.fixture(scope="module")
def small():
    """Poses of some 270 vertices, of which one is a file with names of materials."""
    body = ss.skinned_body("quadruped", 500)
    return ss.Poses([body.pose(name) for name in ("stand", "stride", "sit")], body)


def test_poses_come_back_whole(tmp_path):
    (tmp_path / "a.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nusemtl s\ng left\nf 1 2 3 4\nl 2 5\n"
    )
    poses = ss.read(tmp_path / "a.obj")
    again = copied(poses)
    np.testing.assert_array_equal(again.vertices, poses.vertices)
    np.testing.assert_array_equal(again.edges, poses.edges)
    for name in ("polygons", "names", "warnings", "dropped"):
        assert getattr(again, name) == getattr(poses, name)
    for name, mesh in (("one.obj", poses), ("two.obj", again)):
        ss.write(tmp_path / name, poses[0], mesh)
    assert (tmp_path / "one.obj").read_bytes() == (tmp_path / "two.obj").read_bytes()


def test_metrics_measure_the_same(small):
    stiff = np.linspace(1, 2, len(small[0]))
    metric = ss.Metric(small, bending=1e-3, volume=0.5, bending_stiffness=stiff, pairs="all")
    again = copied(metric)
    tangent = small[1] - small[0]
    assert again.norm(small[0], tangent) == metric.norm(small[0], tangent)
    assert again.unit == metric.unit and repr(again) == repr(metric)
    np.testing.assert_array_equal(again.hinges, metric.hinges)
    one = ss.interpolate(small[:2], small, metric=metric, shapes=1).path
    two = ss.interpolate(small[:2], small, metric=again, shapes=1).path
    np.testing.assert_array_equal(one.vertices, two.vertices)


@pytest.fixture(scope="module")
def results(small):
    """What every solver returns."""
    pair = small[:2]
    path = ss.interpolate(pair, small, shapes=3).path
    rest = small[0]
    feet, head = ss.Handle(rest[:, 1] < 0.1), ss.Handle(rest[:, 1] > 1.4, translation=(0, 0.1, 0))
    markers = np.arange(0, len(rest), 20)
    return [
        ss.interpolate(pair, small, shapes=3),
        ss.spline(small, shapes=1),
        ss.average(small),
        ss.stand(path, [(rest[:, 1] < 0.1, (0, 1))]),
        ss.extrapolate(path, 1),
        ss.correct_path(path),
        ss.transport(path, [path[1] - path[0]]),
        ss.transfer(path, rest),
        ss.transfer_poses(pair, rest, small),
        ss.deform(rest, small, [feet, head]),
        ss.repair(rest, small[1], small),
        ss.explore(small, depth=0, geodesic={"shapes": 1}),
        (ss.correspond(rest, small, rest, small, np.stack([markers, markers], 1)),),
        (ss.ShapeModel().fit(small), path.skin(3)),
        (ss.film_strip(path, frame_width=32), feet, head),
        (ss.compare_shapes(path.metric, path[0], path[1]),),
    ]


def assert_same(one, two):
    assert type(one) is type(two)
    if isinstance(one, np.ndarray):
        np.testing.assert_array_equal(one, two)
    elif isinstance(one, (list, tuple)):
        assert len(one) == len(two)
        for a, b in zip(one, two):
            assert_same(a, b)
    else:
        assert repr(one) == repr(two) and str(one) == str(two)
        for name in ("vertices", "fitted", "mean_", "pixels", "distances"):
            if hasattr(one, name):
                assert_same(getattr(one, name), getattr(two, name))
        if hasattr(one, "to_dict"):
            assert one.to_dict() == two.to_dict()
        for name in getattr(type(one), "_fields", ()):
            assert_same(getattr(one, name), getattr(two, name))


def test_results_come_back_with_their_summaries(results):
    for result in results:
        assert_same(copied(result), result)


def test_what_deforms_and_interpolates_goes_on_elsewhere(small):
    top = small[0][:, 1] > 1.4
    handles = [ss.Handle(~top), ss.Handle(top, translation=(0, 0.1, 0))]
    deformer = ss.Deformer(small[0], small, shapes=1)
    assert_same(copied(deformer).deform(handles).path, deformer.deform(handles).path)
    interpolator = ss.Interpolator(small, shapes=1)
    assert_same(
        copied(interpolator).between(small[0], small[2]).path,
        interpolator.between(small[0], small[2]).path,
    )


def interpolated(poses):
    return ss.interpolate(poses, shapes=1)


def test_a_pool_of_processes_takes_and_returns_them(small):
    pairs = [ss.Poses(small[k : k + 2], small) for k in range(2)]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        found = pool.map(interpolated, pairs)
    for result, pair in zip(found, pairs):
        assert result.summary.converged
        assert_same(result.path, interpolated(pair).path)


def test_a_damaged_pickle_is_refused(small):
    content = bytearray(pickle.dumps(small))
    content[len(content) // 2] ^= 1
    with pytest.raises(ss.FileError, match="damaged"):
        pickle.loads(bytes(content))
