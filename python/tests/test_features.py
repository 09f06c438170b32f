"""Features that are written in Python do what the same features of the library do."""

import inspect
import pickle
import subprocess
import sys
import textwrap
import threading

import numpy as np
import pytest

import shapespace as ss

# Without the library's strains, so that the feature in question is what shapes the path.
REST = {"strain": 0.0, "bending": 1e-5}


def half_square(x):
    """|e|^2 / 2 of edges, as the library's `edge length`."""
    edge = x[:, 1] - x[:, 0]
    return 0.5 * (edge * edge).sum(axis=1), np.stack([-edge, edge], axis=1)


def edges_by_area(basis):
    return basis.edges, basis.edge_area / basis.squared_length**2


def log_length(x, epsilon_squared):
    """log |e| of edges, as the library's `log length`."""
    edge = x[:, 1] - x[:, 0]
    square = (edge * edge).sum(axis=1)[:, None] + epsilon_squared
    return 0.5 * np.log(square), (np.stack([-edge, edge], axis=1) / square[:, None])[:, None]


def loose_edges(basis):
    return basis.edges, basis.edge_area, {"epsilon_squared": basis.collapsed_squared}


def position(x):
    """The library's `position`, which has three values."""
    return x[:, 0], np.broadcast_to(np.eye(3)[None, :, None], (len(x), 3, 1, 3))


def volume(x, reference):
    """The share of a triangle in the library's `volume`, which is a sum."""
    p, q, r = x[:, 0], x[:, 1], x[:, 2]
    normals = np.stack([np.cross(q, r), np.cross(r, p), np.cross(p, q)], axis=1)
    return (p * normals[:, 0]).sum(axis=1) / (6 * reference), normals / (6 * reference)


def enclosed(basis):
    p, q, r = basis.poses[:, basis.faces].transpose(2, 0, 1, 3)
    mean = (p * np.cross(q, r)).sum(axis=(1, 2)).mean() / 6
    return basis.faces, [1.0], {"reference": abs(mean)}


@pytest.fixture(scope="module", autouse=True)
def defined():
    ss.define_feature("own length", half_square, edges_by_area, vertices=2)
    ss.define_feature(
        "own log length", log_length, loose_edges, vertices=2, constants=["epsilon_squared"]
    )
    ss.define_feature("own place", position, "vertices", values=3, rigid_invariant=False)
    ss.define_feature(
        "own volume", volume, enclosed, vertices=3, constants=["reference"], is_sum=True
    )


OWN_LENGTH = {**REST, "isometric": 0.0, "features": {"own length": 1.0}}
LENGTH = {**REST, "isometric": 1.0}


def test_values_and_derivatives_are_those_of_the_library(poses, animal):
    pytest.importorskip("scipy")
    own, library = (ss.Metric(poses, animal.faces, **options) for options in (OWN_LENGTH, LENGTH))
    a, b = own.matrix(poses[0]), library.matrix(poses[0])
    assert abs(a - b).max() < 1e-13 * abs(b).max()
    bounds = [metric.energy_lower_bound(*poses, 4) for metric in (own, library)]
    assert bounds[0] == pytest.approx(bounds[1], rel=1e-12)
    assert own.options["features"] == {"own length": 1.0}
    assert "own length 1" in repr(own)


def test_the_geodesic_is_that_of_the_library_on_all_levels(poses, animal):
    own, library = (
        ss.interpolate(poses, animal.faces, shapes=7, tolerance=1e-10, metric=options)
        for options in (OWN_LENGTH, LENGTH)
    )
    assert own.summary.converged and len(own.summary.hierarchy) > 1
    assert own.summary.energy == pytest.approx(library.summary.energy, rel=1e-9)
    assert own.summary.lower_bound == pytest.approx(library.summary.lower_bound, rel=1e-12)
    assert own.summary.parts["own length"] == pytest.approx(
        library.summary.parts["edge length"], rel=1e-7
    )
    np.testing.assert_allclose(own.path.vertices, library.path.vertices, atol=1e-7)


def test_the_geodesic_is_that_of_the_library_with_ceres_trust_region(poses, animal):
    options = {"shapes": 1, "solver": "trust_region", "tolerance": 1e-10}
    own, library = (
        ss.interpolate(poses, animal.faces, metric=metric, **options)
        for metric in (OWN_LENGTH, LENGTH)
    )
    np.testing.assert_allclose(own.path.vertices, library.path.vertices, atol=1e-7)


@pytest.fixture(scope="module")
def frame():
    """Two poses of a frame of segments without faces, which the library holds by `log length`."""
    corners = np.array(np.meshgrid([0, 1, 2, 3], [0, 1], [0, 1])).reshape(3, -1).T.astype(float)
    distance = np.linalg.norm(corners[:, None] - corners[None], axis=2)
    segments = np.argwhere(np.triu((distance > 0) & (distance < 1.8)))
    bent = corners.copy()
    bent[:, 1] += 0.2 * corners[:, 0] ** 2
    bent[:, 2] *= 1.3
    return ss.Poses([corners, bent], segments=segments)


def test_paths_go_on_and_tangents_are_carried_as_in_the_library(frame):
    start = ss.interpolate(frame, metric={"strain": 1.0}, shapes=7, tolerance=1e-11).path
    found, steps = [], []
    for options in ({"strain": 1.0}, {"strain": 0.0, "features": {"own log length": 1.0}}):
        metric = ss.Metric(frame, **options)
        path = ss.Path(start.vertices, metric, start.parameters)
        longer, summary = ss.extrapolate(path, 4)
        steps.append(summary.steps)
        velocity = metric.log(frame[0], frame[1], steps=8)
        carried = ss.transport(path, [frame[1] - frame[0]]).tangents
        found.append([longer.vertices, velocity, carried, metric.exp(frame[0], velocity, steps=8)])
    for library, python in zip(*found):
        np.testing.assert_allclose(python, library, atol=1e-5)
    # Newton's method begins where second derivatives say. Here they come from differences, whose last
    # digits depend on numpy, and with them the iterations that it takes to 1e-11.
    for library, python in zip(*steps):
        assert python.increments == library.increments
        assert python.iterations <= 3 * library.iterations


def test_features_with_several_values_that_rotation_changes(poses, animal):
    pytest.importorskip("scipy")
    own = {"lambda_": 0.0, "features": {"own place": 1e-3}}
    one, two = (
        ss.interpolate(poses, animal.faces, shapes=3, tolerance=1e-10, metric=metric)
        for metric in (own, {"lambda_": 0.0, "features": {"position": 1e-3}})
    )
    assert one.summary.parts["own place"] == pytest.approx(two.summary.parts["position"], rel=1e-4)
    a, b = (path.metric.matrix(poses[1]) for path in (one.path, two.path))
    assert abs(a - b).max() < 1e-13 * abs(b).max()


def test_sums_are_those_of_the_library(poses, animal):
    own = {"features": {"own volume": 0.5}}
    one, two = (
        ss.interpolate(poses, animal.faces, shapes=3, tolerance=1e-10, metric=metric)
        for metric in (own, {"volume": 0.5})
    )
    assert one.summary.parts["own volume"] == pytest.approx(two.summary.parts["volume"], rel=1e-6)
    np.testing.assert_allclose(one.path.vertices, two.path.vertices, atol=1e-6)


def test_deformation_takes_features(animal):
    rest = animal.pose("stand")
    handles = [
        ss.Handle(rest[:, 1] < 0.1),
        ss.Handle(rest[:, 1] > 1.4, translation=(0, -0.2, 0.1)),
    ]
    found = []
    for metric in (LENGTH, OWN_LENGTH):
        result = ss.deform(rest, animal.faces, handles, metric=metric, tolerance=1e-7)
        assert result.summary.converged
        found.append(result)
    assert found[1].summary.energy == pytest.approx(found[0].summary.energy, rel=1e-5)
    np.testing.assert_allclose(found[1].path[-1], found[0].path[-1], atol=1e-4)


def test_results_do_not_depend_on_the_number_of_threads(poses, animal):
    several = [*poses, animal.pose("stand")]
    found = []
    before = ss.threads()
    try:
        for threads in (1, 4):
            ss.set_threads(threads)
            path = ss.interpolate(poses, animal.faces, shapes=3, metric=OWN_LENGTH).path
            lengths = ss.distance_matrix(
                several, animal.faces, geodesic={"shapes": 1, "metric": OWN_LENGTH}
            )
            found.append((path.vertices, lengths))
    finally:
        ss.set_threads(before)
    np.testing.assert_array_equal(found[0][0], found[1][0])
    np.testing.assert_array_equal(found[0][1], found[1][1])


def test_files_and_copies_have_the_feature(frame, tmp_path):
    metric = {"strain": 0.0, "features": {"own log length": 1.0}}
    path = ss.interpolate(frame, metric=metric, shapes=3).path
    path.write(tmp_path / "own.path")
    longer = ss.extrapolate(path, 2).path.vertices
    for same in (ss.Path.read(tmp_path / "own.path"), pickle.loads(pickle.dumps(path))):
        assert same.metric.options["features"] == {"own log length": 1.0}
        np.testing.assert_array_equal(ss.extrapolate(same, 2).path.vertices, longer)
    stranger = f"import shapespace as ss; ss.Path.read({str(tmp_path / 'own.path')!r})"
    run = subprocess.run([sys.executable, "-c", stranger], capture_output=True, text=True)
    assert run.returncode == 1
    assert "FileError" in run.stderr and "own log length" in run.stderr
    assert "define_feature" in run.stderr


def test_models_of_shapes_with_the_feature_can_be_copied(poses, animal):
    ss.set_threads(4)
    try:
        model = ss.ShapeModel(modes=1, metric=OWN_LENGTH).fit(
            [*poses, animal.pose("stand")], animal.faces
        )
        same = pickle.loads(pickle.dumps(model))
    finally:
        ss.set_threads(0)
    np.testing.assert_array_equal(same.inverse_transform([[1.0]]), model.inverse_transform([[1.0]]))


class Mine(Exception):
    pass


def failing(after):
    """`half_square`, which raises when it has been called so often."""
    calls = []

    def function(x):
        calls.append(threading.get_ident())
        if len(calls) > after:
            raise Mine(f"call {len(calls)}")
        return half_square(x)

    return function


CALLS = {
    "interpolate": lambda p, f, m: ss.interpolate(p, f, shapes=3, metric=m),
    "trust region": lambda p, f, m: ss.interpolate(
        p, f, shapes=1, metric=m, solver="trust_region"
    ),
    "Metric": lambda p, f, m: ss.Metric(p, f, **m).norm(p[0], p[1] - p[0]),
    "matrix": lambda p, f, m: ss.Metric(p, f, **m).matrix(p[0]),
    "distances": lambda p, f, m: ss.distance_matrix(p, f, geodesic={"shapes": 1, "metric": m}),
    "extrapolate": lambda p, f, m: ss.extrapolate(ss.Path(p, ss.Metric(p, f, **m)), 2),
    "deform": lambda p, f, m: ss.deform(
        p[0], f, [ss.Handle(p[0][:, 1] < 0.1), ss.Handle([0], translation=(0, 0.1, 0))], metric=m
    ),
}


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("after", [0, 3, 30])
@pytest.mark.parametrize("threads", [1, 4])
def test_what_the_function_raises_comes_out(poses, animal, call, after, threads):
    if call == "matrix":
        pytest.importorskip("scipy")
    ss.define_feature("failing", failing(after), edges_by_area, vertices=2)
    ss.set_threads(threads)
    try:
        with pytest.raises(Mine, match="call") as caught:
            for _ in range(after + 1):  # until it has been called often enough
                CALLS[call](poses, animal.faces, {**REST, "features": {"failing": 1.0}})
    finally:
        ss.set_threads(0)
    assert any(entry.name == "function" for entry in caught.traceback)
    ss.interpolate(poses, animal.faces, shapes=1)  # nothing is left of it


def test_what_elements_raises_comes_out(poses, animal):
    def elements(basis):
        raise Mine("no elements")

    ss.define_feature("failing", half_square, elements, vertices=2)
    with pytest.raises(Mine):
        ss.interpolate(poses, animal.faces, metric={"features": {"failing": 1.0}})


def test_progress_stops_a_solve_that_calls_python(poses, animal):
    def stop(stage, done, total, share):
        return share is None or share < 0.3

    _, summary = ss.interpolate(poses, animal.faces, metric=OWN_LENGTH, progress=stop)
    assert summary.termination == "cancelled"

    def fail(stage, done, total, share):
        raise Mine(stage)

    with pytest.raises(Mine):
        ss.interpolate(poses, animal.faces, metric=OWN_LENGTH, progress=fail)


def test_ctrl_c_and_the_end_of_the_process(tmp_path):
    """The solver is left behind in a function of Python's, which runs when the process ends."""
    program = textwrap.dedent(
        """
        import _thread, signal, threading, time
        import shapespace as ss

        # A program that is started in the background may have been told to ignore it.
        signal.signal(signal.SIGINT, signal.default_int_handler)

        begun = threading.Event()

        def slow(x):
            begun.set()
            time.sleep(0.05)
            edge = x[:, 1] - x[:, 0]
            return 0.5 * (edge * edge).sum(axis=1), __import__("numpy").stack([-edge, edge], 1)

        ss.define_feature("slow", slow, "edges")
        body = ss.skinned_body("quadruped", 1500)
        poses = [body.pose("sit"), body.pose("stretch")]

        def interrupt():
            begun.wait()
            time.sleep(0.3)
            _thread.interrupt_main()

        threading.Thread(target=interrupt).start()
        try:
            ss.interpolate(poses, body, metric={"features": {"slow": 1.0}})
        except KeyboardInterrupt:
            print("interrupted")
        """
    )
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=120
    )
    assert (run.returncode, run.stdout, run.stderr) == (0, "interrupted\n", "")


def returning(change):
    """A function on edges with the values and derivatives that `change` makes of the right ones."""

    def function(x):
        return change(*half_square(x))

    return function


BAD = {
    "nothing": (lambda v, d: None, "must return two arrays, not NoneType"),
    "values alone": (lambda v, d: v, "must return two arrays, not ndarray"),
    "too few": (lambda v, d: (v[1:], d), r"values of shape \(\d+,\) where \(\d+, 1\) is needed"),
    "transposed": (
        lambda v, d: (v, d.transpose(0, 2, 1)),
        r"derivatives of shape \(\d+, 3, 2\) where \(\d+, 1, 2, 3\) is needed",
    ),
    "text": (lambda v, d: (v.astype(str), d), "values must be numbers, not <U"),
    "nan": (lambda v, d: (v * np.nan, d), r"values \[nan\], which are not finite, at x\[0\] ="),
    "infinite": (
        lambda v, d: (v, d + np.where(np.arange(len(v)) == 2, np.inf, 0)[:, None, None]),
        r"derivatives .*inf.*, which are not finite, at x\[2\] = ",
    ),
    "sign": (lambda v, d: (v, -d), r"of value 0 by coordinate [xyz] of vertex [01] it is"),
    "twice": (lambda v, d: (v, 2 * d), "the derivatives are not those of the values"),
}


@pytest.mark.parametrize("case", BAD)
def test_results_that_are_none_are_refused(poses, animal, case):
    change, message = BAD[case]
    ss.define_feature("bad", returning(change), edges_by_area, vertices=2)
    with pytest.raises(ss.InvalidOptions, match="feature bad: .*" + message):
        ss.interpolate(poses, animal.faces, shapes=1, metric={"features": {"bad": 1.0}})


def test_values_that_stop_being_numbers_on_the_way_are_refused(poses, animal):
    """The poses themselves have values, so that the feature can be frozen."""
    calls = []

    def function(x):
        calls.append(len(x))
        values, derivatives = half_square(x)
        return (values if len(calls) < 40 else np.nan * values), derivatives

    ss.define_feature("bad", function, edges_by_area, vertices=2)
    with pytest.raises(ss.InvalidOptions, match="feature bad: .*nan"):
        ss.interpolate(poses, animal.faces, metric={"features": {"bad": 1.0}})


@pytest.mark.parametrize(
    "elements, message",
    [
        (lambda basis: basis.edges, "`elements` must return two arrays"),
        (lambda basis: (basis.faces, basis.triangle_area), r"elements have shape \(\d+, 3\)"),
        (lambda basis: (basis.edges + 0.5, basis.edge_area), "elements must be numbers, not float"),
        (lambda basis: (basis.edges, basis.triangle_area), "weights have shape"),
        (lambda basis: (basis.edges, -basis.edge_area), "weight 0 is not a number of zero or more"),
        (lambda basis: (basis.edges - 1, basis.edge_area), "has vertex -1, which is not one of"),
    ],
)
def test_elements_that_do_not_fit_the_mesh_are_refused(poses, animal, elements, message):
    ss.define_feature("bad", half_square, elements, vertices=2)
    with pytest.raises(ss.InvalidOptions, match="feature bad: .*" + message):
        ss.Metric(poses, animal.faces, features={"bad": 1.0})


def test_constants_that_are_not_those_that_were_named_are_refused(poses, animal):
    for elements in (edges_by_area, lambda basis: (*edges_by_area(basis), {"other": 1.0})):
        ss.define_feature("bad", half_square, elements, vertices=2, constants=["scale"])
        with pytest.raises(ss.InvalidOptions, match="feature bad: .*constants"):
            ss.Metric(poses, animal.faces, features={"bad": 1.0})


@pytest.mark.parametrize(
    "arguments, options, error, message",
    [
        (("", half_square, "edges"), {}, TypeError, "name: "),
        (("bad", None, "edges"), {}, TypeError, "function: must be callable"),
        (("bad", half_square, "corners"), {}, ValueError, "elements: must be 'vertices', 'edges'"),
        (("bad", half_square, edges_by_area), {}, TypeError, "vertices: must be an int"),
        (("bad", half_square, edges_by_area), {"vertices": 9}, ValueError, "must be 1 to 8"),
        (("bad", half_square, "edges"), {"vertices": 3}, ValueError, "these elements have 2"),
        (("bad", half_square, "edges"), {"values": 0}, ValueError, "values: must be 1 to 8"),
        (("bad", half_square, "edges"), {"values": 2, "is_sum": True}, ValueError, "a sum has one"),
        (("bad", half_square, "edges"), {"constants": "scale"}, TypeError, "constants: must be"),
        (("volume", half_square, "edges"), {}, ss.InvalidOptions, "feature volume: .*another type"),
    ],
)
def test_definitions_that_are_none_are_refused(arguments, options, error, message):
    with pytest.raises(error, match=message):
        ss.define_feature(*arguments, **options)


def test_options_name_features_and_their_coefficients(poses, animal):
    for features, error, message in [
        ({"no such feature": 1.0}, ss.InvalidOptions, "no such feature: is not known.*define_feat"),
        ({"own length": -1.0}, ss.InvalidOptions, "features, own length: must be a number"),
        ({"own length": "1"}, TypeError, r"features\['own length'\]: must be float"),
        (["own length"], TypeError, "features: must be dict of str to float"),
    ]:
        with pytest.raises(error, match=message):
            ss.Metric(poses, animal.faces, features=features)
    assert inspect.signature(ss.Metric).parameters["features"].default is None


def test_a_definition_is_replaced_but_not_in_metrics_that_are_frozen(poses, animal):
    ss.define_feature("twofold", half_square, edges_by_area, vertices=2)
    one = ss.Metric(poses, animal.faces, strain=0, features={"twofold": 1.0})
    tangent = poses[1] - poses[0]
    norm = one.norm(poses[0], tangent)

    def twice(x):
        values, derivatives = half_square(x)
        return 2 * values, 2 * derivatives

    ss.define_feature("twofold", twice, edges_by_area, vertices=2)
    two = ss.Metric(poses, animal.faces, strain=0, lambda_=0, features={"twofold": 1.0})
    alone = ss.Metric(poses, animal.faces, strain=0, lambda_=0, isometric=1)
    assert one.norm(poses[0], tangent) == norm
    assert two.norm(poses[0], tangent) == pytest.approx(
        (4 * alone.norm(poses[0], tangent) ** 2 - 3 * bending_part(poses, animal, tangent)) ** 0.5
    )


def bending_part(poses, animal, tangent):
    """The squared norm by the library's default bending alone."""
    with_bending = ss.Metric(poses, animal.faces, strain=0, lambda_=0, isometric=1)
    without = ss.Metric(poses, animal.faces, strain=0, lambda_=0, isometric=1, bending=0)
    return with_bending.norm(poses[0], tangent) ** 2 - without.norm(poses[0], tangent) ** 2


def test_the_basis_has_the_mesh_in_the_unit_of_the_metric(poses, animal):
    seen = []

    def elements(basis):
        seen.append(basis)
        return edges_by_area(basis)

    ss.define_feature("looking", half_square, elements, vertices=2)
    metric = ss.Metric(poses, animal.faces, features={"looking": 1.0})
    (basis,) = seen
    assert basis.unit == metric.unit
    corners = basis.poses[:, basis.faces]
    areas = np.linalg.norm(np.cross(corners[:, :, 1] - corners[:, :, 0],
                                    corners[:, :, 2] - corners[:, :, 0]), axis=2) / 2  # fmt: skip
    np.testing.assert_allclose(areas.mean(axis=0), basis.triangle_area, rtol=1e-9)
    assert basis.triangle_area.sum() == pytest.approx(1)
    np.testing.assert_array_equal(basis.faces, metric.faces)
    np.testing.assert_array_equal(basis.edges, metric.edges)
    np.testing.assert_array_equal(basis.hinges, metric.hinges)
    for name in ("vertex_area", "edge_area", "hinge_area"):
        np.testing.assert_array_equal(getattr(basis, name), getattr(metric, name))
    for name, count in (("triangle", basis.faces), ("edge", basis.edges), ("hinge", basis.hinges)):
        np.testing.assert_array_equal(getattr(basis, name + "_stiffness"), np.ones(len(count)))
    assert 0 < basis.collapsed_squared < 1e-10 * basis.squared_length.mean()


@pytest.mark.parametrize(
    "elements, count", [("vertices", 1), ("edges", 2), ("triangles", 3), ("hinges", 4)]
)
def test_words_stand_for_elements_that_weigh_their_area(poses, animal, elements, count):
    """The mean of an element's vertices: a linear map, so that all of the metric is known."""

    def mean(x):
        slope = np.eye(3)[:, None] / count
        return x.mean(axis=1), np.broadcast_to(slope, (len(x), 3, count, 3))

    ss.define_feature("mean", mean, elements, values=3, rigid_invariant=False)
    metric = ss.Metric(
        poses, animal.faces, strain=0, bending=0, lambda_=0, features={"mean": 2.0}
    )
    tangent = np.random.default_rng(1).normal(size=poses[0].shape)
    stencils, areas = {
        "vertices": (np.arange(len(tangent))[:, None], metric.vertex_area),
        "edges": (metric.edges, metric.edge_area),
        "hinges": (metric.hinges, metric.hinge_area),
        "triangles": (metric.faces, None),
    }[elements]
    if areas is None:
        corners = np.array(poses)[:, metric.faces] / metric.unit
        sides = corners[:, :, 1:] - corners[:, :, :1]
        areas = np.linalg.norm(np.cross(sides[:, :, 0], sides[:, :, 1]), axis=2).mean(axis=0) / 2
    expected = 2 * (areas * (tangent[stencils].mean(axis=1) ** 2).sum(axis=1)).sum()
    assert metric.norm(poses[0], tangent * metric.unit) ** 2 == pytest.approx(expected)
