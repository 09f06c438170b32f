"""Shape models, as scikit-learn would use them."""

import inspect
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
    assert model.mean_.shape == poses[0].shape
    assert model.modes_.shape == (3, *poses[0].shape)
    assert model.explained_variance_ratio_.sum() == pytest.approx(1)
    assert np.all(np.diff(model.explained_variance_ratio_) < 0)
    assert model.summary_.rank == 3
    assert "4 poses, 3 modes" in repr(model)


def test_transform_gives_the_coordinates_of_the_poses(herd, model):
    _, poses = herd
    coordinates = model.transform(poses)
    np.testing.assert_allclose(coordinates, model.coordinates_, atol=1e-5)
    np.testing.assert_allclose(coordinates.mean(axis=0), 0, atol=1e-5)
    np.testing.assert_allclose(coordinates.std(axis=0), 1, atol=1e-5)
    assert model.transform(poses[2]).shape == (1, 3)


def edges(shape, faces):
    return np.linalg.norm(shape[faces] - shape[np.roll(faces, 1, axis=1)], axis=-1)


def test_inverse_transform_leads_back(herd, model):
    body, poses = herd
    for shape, pose in zip(model.inverse_transform(model.coordinates_), poses):
        np.testing.assert_allclose(edges(shape, body.faces), edges(pose, body.faces), rtol=1e-2)
    np.testing.assert_allclose(model.inverse_transform([0.0])[0], model.mean_, atol=1e-6)
    near = model.preview([0.5])
    exact = model.inverse_transform([0.5])[0]
    assert np.abs(near - exact).max() < 0.05 * np.ptp(exact)


def test_samples_are_the_same_for_a_seed(model):
    assert model.sample(3).shape == (3, 3)
    np.testing.assert_array_equal(model.sample(2, seed=5)[1], model.sample(seed=6)[0])


def test_models_are_written_and_pickled(model, tmp_path):
    model.write(tmp_path / "herd.modes")
    read, pickled = ss.ShapeModel.read(tmp_path / "herd.modes"), pickle.loads(pickle.dumps(model))
    assert read.summary_ is None and str(pickled.summary_) == str(model.summary_)
    for copy in (read, pickled):
        np.testing.assert_array_equal(copy.coordinates_, model.coordinates_)
        np.testing.assert_array_equal(
            copy.inverse_transform([1, -1]), model.inverse_transform([1, -1])
        )
    assert pickle.loads(pickle.dumps(ss.ShapeModel(modes=2))).modes == 2


def test_what_cannot_be_is_refused(herd, model):
    body, poses = herd
    with pytest.raises(ss.InvalidOptions, match="modes: must be at most 3"):
        ss.ShapeModel(modes=4).fit(poses, body.faces)
    with pytest.raises(ss.NotFittedError, match="call fit first"):
        ss.ShapeModel().mean_  # noqa: B018
    with pytest.raises(ss.InvalidOptions, match="coordinates"):
        model.inverse_transform([[0, 0, 0, 1]])
    with pytest.raises(TypeError):
        ss.ShapeModel(nodes=3).fit(poses, body.faces)


def test_parameters_are_attributes_and_copied(herd):
    body, poses = herd
    metric = {"bending": 1e-4}
    model = ss.ShapeModel(modes=2, metric=metric)
    clone = type(model)(**model.get_params(deep=False))
    assert clone.get_params() == model.get_params() and clone.get_params()["metric"] is metric
    assert set(model.get_params()) == set(inspect.signature(ss.ShapeModel).parameters)
    assert model.set_params(modes=3) is model and (model.modes, clone.modes) == (3, 2)
    own = ss.ShapeModel(modes=2, metric=metric, faces=body).fit(poses)
    np.testing.assert_array_equal(clone.fit(poses, body.faces).mean_, own.mean_)
    with pytest.raises(ValueError, match="nodes"):
        model.set_params(nodes=3)


# What scikit-learn asks of an estimator without data; all else fits arrays of two dimensions, which
# are no meshes.
CHECKS = {
    "check_fit1d",
    "check_get_params_invariance",
    "check_no_attributes_set_in_init",
    "check_parameters_default_constructible",
    "check_set_params",
    "check_transformers_unfitted",
}


def test_scikit_learn_takes_a_model(herd):
    body, poses = herd
    pytest.importorskip("sklearn", reason="python3-sklearn is not installed")
    from sklearn.base import clone
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler
    from sklearn.utils.estimator_checks import check_estimator
    from sklearn.utils.validation import check_is_fitted

    model = ss.ShapeModel(modes=2, faces=body.faces)
    cloned = clone(model)
    assert cloned.get_params()["modes"] == 2
    with pytest.raises((ValueError, TypeError)):
        check_is_fitted(cloned)
    scaled = make_pipeline(model, StandardScaler()).fit(np.array(poses)).transform(poses)
    assert scaled.shape == (4, 2)
    check_is_fitted(model)
    ran = set()  # versions of scikit-learn differ in what they ask
    for estimator, check in check_estimator(ss.ShapeModel(), generate_only=True):
        name = check.func.__name__
        if name in CHECKS:
            check(estimator)
            ran.add(name)
    assert len(ran) > 3
