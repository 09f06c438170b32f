"""Shape models, as scikit-learn would use them."""

import pickle

import numpy as np
import pytest

import shapespace as ss


@pytest.fixture(scope="module")
def herd():
    body = ss.skinned_body("quadruped", 400)
    return body, [body.pose(name) for name in ("stand", "stride", "sit", "stretch")]


@pytest.fixture(scope="module")
def model(herd):
    body, poses = herd
    return ss.ShapeModel().fit(poses, body.faces)


def test_a_model_has_a_mean_and_modes(herd, model):
    _, poses = herd
    assert model.mean.shape == poses[0].shape
    assert model.modes.shape == (3, *poses[0].shape)
    assert model.explained_variance_ratio_.sum() == pytest.approx(1)
    assert np.all(np.diff(model.explained_variance_ratio_) < 0)
    assert model.summary.rank == 3
    assert "4 poses, 3 modes" in repr(model)


def test_transform_gives_the_coordinates_of_the_poses(herd, model):
    _, poses = herd
    coordinates = model.transform(poses)
    np.testing.assert_allclose(coordinates, model.coordinates, atol=1e-5)
    np.testing.assert_allclose(coordinates.mean(axis=0), 0, atol=1e-5)
    np.testing.assert_allclose(coordinates.std(axis=0), 1, atol=1e-5)
    assert model.transform(poses[2]).shape == (1, 3)


def edges(shape, faces):
    return np.linalg.norm(shape[faces] - shape[np.roll(faces, 1, axis=1)], axis=-1)


def test_inverse_transform_leads_back(herd, model):
    body, poses = herd
    for shape, pose in zip(model.inverse_transform(model.coordinates), poses):
        np.testing.assert_allclose(edges(shape, body.faces), edges(pose, body.faces), rtol=1e-2)
    np.testing.assert_allclose(model.inverse_transform([0.0])[0], model.mean, atol=1e-6)
    near = model.preview([0.5])
    exact = model.inverse_transform([0.5])[0]
    assert np.abs(near - exact).max() < 0.05 * np.ptp(exact)


def test_samples_are_the_same_for_a_seed(model):
    assert model.sample(3).shape == (3, 3)
    np.testing.assert_array_equal(model.sample(2, seed=5)[1], model.sample(seed=6)[0])


def test_models_are_written_and_pickled(model, tmp_path):
    model.write(tmp_path / "herd.modes")
    read, pickled = ss.ShapeModel.read(tmp_path / "herd.modes"), pickle.loads(pickle.dumps(model))
    assert read.summary is None and str(pickled.summary) == str(model.summary)
    for copy in (read, pickled):
        np.testing.assert_array_equal(copy.coordinates, model.coordinates)
        np.testing.assert_array_equal(
            copy.inverse_transform([1, -1]), model.inverse_transform([1, -1])
        )
    assert pickle.loads(pickle.dumps(ss.ShapeModel(modes=2)))._options == {"modes": 2}


def test_what_cannot_be_is_refused(herd, model):
    body, poses = herd
    with pytest.raises(ss.InvalidOptions, match="modes: must be at most 3"):
        ss.ShapeModel(modes=4).fit(poses, body.faces)
    with pytest.raises(ss.NotFittedError, match="call fit first"):
        ss.ShapeModel().mean  # noqa: B018
    with pytest.raises(ss.InvalidOptions, match="coordinates"):
        model.inverse_transform([[0, 0, 0, 1]])
    with pytest.raises(TypeError):
        ss.ShapeModel(nodes=3).fit(poses, body.faces)


# What sklearn.base.clone does.
def test_a_model_is_cloned_by_its_parameters():
    metric = {"bending": 1e-4}
    model = ss.ShapeModel(modes=2, metric=metric)
    clone = type(model)(**model.get_params(deep=False))
    assert clone.get_params() == {"modes": 2, "metric": metric}
    assert clone.get_params()["metric"] is metric
    assert model.set_params(modes=3) is model
    assert model.get_params() == {"modes": 3, "metric": metric}
    assert clone.get_params()["modes"] == 2
