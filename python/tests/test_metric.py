"""The methods of a metric, and a metric in the place of options."""

import numpy as np
import pytest

import shapespace as ss


@pytest.fixture(scope="module")
def stride():
    body = ss.skinned_body("quadruped", 500)
    shapes = [body.pose("stand"), body.pose("stride")]
    return shapes, ss.Metric(shapes, body)


def test_the_logarithm_leads_back_by_as_many_steps(stride):
    (start, end), metric = stride
    velocity = metric.log(start, end, steps=8)
    np.testing.assert_array_equal(velocity, ss.logarithm(metric, start, end, 8))
    reached = metric.exp(start, velocity, steps=8)
    assert ss.compare_shapes(metric, end, reached).edge_rms < 1e-4
    with pytest.raises(ValueError, match="steps: must be at least 2"):
        metric.log(start, end, steps=1)
    # The geodesic's length is that of its initial velocity.
    length = metric.dist(start, end, shapes=7, tolerance=1e-10)
    np.testing.assert_allclose(metric.norm(start, velocity), length, rtol=1e-3)
    np.testing.assert_allclose(
        length, ss.distance_matrix([start, end], metric, geodesic={"shapes": 7})[0, 1], rtol=1e-2
    )


def test_a_geodesic_that_is_not_found_has_no_length(stride):
    (start, end), metric = stride
    with pytest.raises(ss.SolverError, match="not found"):
        metric.dist(start, end, max_iterations=1)


def test_the_inner_product_is_bilinear_and_that_of_the_norm(stride):
    (start, end), metric = stride
    x = end - start
    y = np.sin(3 * start[:, [1, 2, 0]])
    assert metric.inner(start, x, y) == metric.inner(start, y, x)
    np.testing.assert_allclose(metric.inner(start, x, x), metric.norm(start, x) ** 2)
    np.testing.assert_allclose(
        metric.inner(start, x, 2 * y + x),
        2 * metric.inner(start, x, y) + metric.inner(start, x, x),
    )
    with pytest.raises(ss.MeshError, match="second: has 3 vertices"):
        metric.inner(start, x, y[:3])


def test_transport_keeps_inner_products(stride):
    (start, end), metric = stride
    tangents = [end - start, np.sin(3 * start[:, [1, 2, 0]])]
    there = metric.transport(tangents, start, end, shapes=15)
    np.testing.assert_allclose(
        metric.inner(end, there[0], there[1]), metric.inner(start, *tangents), rtol=0.05
    )


def test_no_path_has_less_energy_than_the_bound(stride):
    (start, end), metric = stride
    path, summary = ss.interpolate([start, end], metric, metric=metric, shapes=3)
    bound = metric.energy_lower_bound(start, end, segments=4)
    np.testing.assert_allclose(bound, summary.lower_bound, rtol=1e-12)
    np.testing.assert_allclose(
        metric.energy_lower_bound(start, end @ np.diag([-1.0, 1, -1]) + 7, segments=4), bound,
        rtol=1e-6,
    )  # fmt: skip
    assert 0 < bound <= summary.energy
    with pytest.raises(ValueError, match="segments"):
        metric.energy_lower_bound(start, end, segments=0)


def test_a_metric_stands_for_its_options(stride):
    shapes, _ = stride
    body = ss.skinned_body("quadruped", 500)
    options = ss.MetricOptions(bending=1e-3)
    metric = ss.Metric(shapes, body, **options)
    for solve in (ss.spline, ss.average):
        by_metric, by_options = (solve(shapes, body, metric=m)[0] for m in (metric, options))
        np.testing.assert_array_equal(
            getattr(by_metric, "vertices", by_metric), getattr(by_options, "vertices", by_options)
        )
    lengths = [ss.distance_matrix(shapes, body, geodesic={"metric": m}) for m in (metric, options)]
    np.testing.assert_array_equal(*lengths)
