"""Options are those of the library: names, defaults, and what is said of values that are none."""

import inspect
import re

import numpy as np
import pytest

import shapespace
from shapespace import _core


def test_signatures_and_docstrings_show_the_library_s_defaults():
    parameters = inspect.signature(shapespace.interpolate).parameters
    for name, _kind, default, meaning in _core.options("GeodesicOptions"):
        if not isinstance(default, dict):
            assert parameters[name].default == default
        assert f"\n{name} : " in shapespace.interpolate.__doc__
        assert meaning.split()[0] in shapespace.interpolate.__doc__
    assert parameters["shapes"].default == 15
    assert "strain 1.0" in " ".join(shapespace.interpolate.__doc__.split())


FUNCTIONS = [
    thing
    for name in shapespace.__all__
    if inspect.isfunction(thing := getattr(shapespace, name))
]


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda function: function.__name__)
def test_docstrings_document_every_parameter(function):
    text = function.__doc__
    assert "{" + "options}" not in text
    assert text.splitlines()[0].endswith(".")
    documented = text.split("Returns\n")[0]
    for name in inspect.signature(function).parameters:
        assert re.search(rf"^( {{4}})?[*\w, ]*\b{name}\b.*$", documented, re.M), name


@pytest.mark.parametrize(
    "options, error, words",
    [
        ({"shpes": 3}, TypeError, "'shpes' is no option here; did you mean 'shapes'?"),
        ({"shapes": "3"}, TypeError, "shapes: must be int, not '3'"),
        ({"shapes": 2.5}, TypeError, "shapes: must be int, not 2.5"),
        ({"shapes": True}, TypeError, "shapes: must be int, not True"),
        ({"shapes": np.True_}, TypeError, "shapes: must be int, not "),
        ({"assess": 1}, TypeError, "assess: must be bool, not 1"),
        ({"shapes": 0}, ValueError, "shapes: "),
        ({"tolerance": -1.0}, ValueError, "tolerance: "),
        ({"tolerance": np.nan}, ValueError, "tolerance: "),
        ({"solver": "newton"}, ValueError, "solver: must be one of .*'trust_region'.*'newton'"),
        ({"solver": None}, TypeError, "solver: "),
        ({"metric": "elastic"}, ValueError, "'elastic' is no preset"),
        ({"metric": {"bend": 1}}, TypeError, "'bend' is no option here; did you mean 'bending'"),
        ({"metric": {"bending": -1.0}}, ValueError, "bending: "),
        ({"metric": 3}, TypeError, "metric: must be MetricOptions, Metric or str, not 3"),
        ({"memory_limit": 1.0}, shapespace.SolverError, "memory"),
    ],
)
def test_what_is_no_option_or_no_value_is_named(options, error, words, poses, animal):
    with pytest.raises(error, match=words):
        shapespace.interpolate(poses, animal.faces, **options)


def test_numpy_s_numbers_are_numbers(poses, animal):
    options = {"shapes": np.int32(1), "tolerance": np.float32(1e-3)}
    assert len(shapespace.interpolate(poses, animal.faces, **options).path) == 3


def test_dicts_of_options_change_what_they_name_alone(poses, animal):
    one = shapespace.transfer_poses(
        poses, poses[0], animal.faces, metric=shapespace.MetricOptions(bending=0.02)
    )
    defaults = {row[0]: row[2] for row in _core.options("TransferOptions")}["metric"]
    two = shapespace.transfer_poses(
        poses, poses[0], animal.faces, metric={**defaults, "bending": 0.02}
    )
    np.testing.assert_array_equal(one.path.vertices, two.path.vertices)


def test_exceptions_are_the_library_s_and_python_s():
    for name, base in [
        ("FileError", OSError),
        ("MeshError", ValueError),
        ("MismatchError", ValueError),
        ("InvalidOptions", ValueError),
        ("SolverError", RuntimeError),
        ("Cancelled", Exception),
    ]:
        error = getattr(shapespace, name)
        assert issubclass(error, base) and issubclass(error, shapespace.Error)
        assert error.__module__ == "shapespace"


def test_summaries_say_what_they_hold(poses, animal):
    summary = shapespace.interpolate(poses, animal.faces, shapes=1).summary
    assert repr(summary).startswith("<GeodesicSummary: converged: ")
    assert "Lower bound" in str(summary)
    assert summary.to_dict()["energy"] == summary.energy
    # The JSON of reports and the attributes are made of one list of fields.
    attributes = {name for name in dir(summary) if not name.startswith("_")} - {"to_dict"}
    assert set(summary.to_dict()) == attributes
    assert summary.to_dict()["quality"]["edge_rms"] == summary.quality.edge_rms
    assert "iterations=" in repr(summary.levels[0])
    with pytest.raises(AttributeError):
        summary.energy = 0


def test_stiffness_of_one_everywhere_is_none(poses, animal):
    ones = np.ones(len(poses[0]))
    plain = shapespace.interpolate(poses, animal.faces, shapes=1).path
    metric = {"stretching_stiffness": ones, "bending_stiffness": ones}
    same = shapespace.interpolate(poses, animal.faces, shapes=1, metric=metric).path
    np.testing.assert_array_equal(same.vertices, plain.vertices)


def test_stiffness_multiplies_what_stretching_costs(poses, animal):
    mesh = shapespace.Poses(poses, animal.faces)
    tangent = poses[1] - poses[0]
    options = {"lambda_": 0.0, "bending": 0.0}
    plain = shapespace.Metric(mesh, **options).norm(poses[0], tangent)
    for on, count in (("vertices", len(poses[0])), ("edges", len(mesh.edges))):
        stiff = shapespace.Metric(
            mesh, stretching_stiffness=np.full(count, 4), stiffness_on=on, **options
        )
        np.testing.assert_allclose(stiff.norm(poses[0], tangent), 2 * plain, rtol=1e-12)


def test_what_is_stiff_deforms_less(poses, animal):
    front = poses[0][:, 2] > 0
    worst = []
    for factor in (1.0, 100.0):
        stiffness = np.where(front, factor, 1.0)
        path = shapespace.interpolate(
            poses, animal.faces, shapes=3, tolerance=1e-6,
            metric={
                "preset": "isometric", "stretching_stiffness": stiffness,
                "bending_stiffness": stiffness,
            },
        ).path  # fmt: skip
        # At the middle, against what the two poses have on average.
        edges = path.metric.edges[front[path.metric.edges].all(axis=1)]
        square = [((v[edges[:, 0]] - v[edges[:, 1]]) ** 2).sum(axis=1) for v in path.vertices]
        expected = (square[0] + square[-1]) / 2
        worst.append(np.sqrt(np.mean((square[2] / expected - 1) ** 2)))
    assert worst[1] < 0.85 * worst[0]


def test_stiffness_of_another_mesh_is_refused(poses, animal):
    with pytest.raises(shapespace.InvalidOptions, match="stretching_stiffness"):
        shapespace.Metric(poses, animal.faces, stretching_stiffness=[1, 2, 3])
    with pytest.raises(ValueError, match="bending_stiffness: must be a one-dimensional"):
        shapespace.Metric(poses, animal.faces, bending_stiffness=np.ones((2, 2)))


def test_numbers_truth_values_and_names_may_be_numpy_s_and_pathlib_s(animal, poses, tmp_path):
    options = {"shapes": np.int64(1), "tolerance": np.float32(1e-3), "assess": np.False_}
    one = shapespace.interpolate(poses, animal, **options)
    two = shapespace.interpolate(poses, animal, shapes=1, tolerance=float(np.float32(1e-3)))
    np.testing.assert_array_equal(one.path.vertices, two.path.vertices)
    assert np.isnan(one.summary.quality.edge_rms)
    records = tmp_path / "records"
    shapespace.distance_matrix(poses, animal, records=records, geodesic={"shapes": 1})
    assert any(records.iterdir())


def test_warnings_name_the_line_of_the_program():
    vertices = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]]
    fan = [[0, 1, 2], [0, 1, 3], [0, 1, 4]]
    with pytest.warns(shapespace.MeshWarning) as direct:
        shapespace.Poses([vertices], fan, allow_nonmanifold=np.True_)
    assert direct[0].filename == __file__
