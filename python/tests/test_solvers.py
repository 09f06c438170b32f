"""What the functions compute: known answers, invariances, and the command line's results."""

import itertools
import pickle

import numpy as np
import pytest

import shapespace


def rms(difference):
    return np.sqrt((difference**2).sum(axis=1).mean())


def test_the_command_line_finds_the_same_to_the_last_bit(tool, tmp_path):
    tool("shape-body", "quadruped", "--triangles", 3000, "--pose", "sit,stretch", "--output",
         "pose%d.obj", cwd=tmp_path)  # fmt: skip
    tool("shape-body", "quadruped", "--triangles", 3000, "--pose", "sit", "--proportions", "long",
         "--output", "other%d.obj", cwd=tmp_path)  # fmt: skip
    tool("shape-interpolate", "pose0.obj", "pose1.obj", "--shapes", 3, "--output",
         "walk.path,walk.png,walk%d.obj", cwd=tmp_path)  # fmt: skip
    tool("shape-transfer", "walk.path", "--target", "other0.obj", "--output", "moved.path",
         cwd=tmp_path)  # fmt: skip

    poses = shapespace.read(tmp_path / "pose0.obj", tmp_path / "pose1.obj")
    path = shapespace.interpolate(poses, shapes=3).path
    theirs = shapespace.Path.read(tmp_path / "walk.path")
    np.testing.assert_array_equal(path.aligned, theirs.aligned)
    np.testing.assert_array_equal(path.vertices, theirs.vertices)
    path.write(tmp_path / "ours.png")
    assert (tmp_path / "ours.png").read_bytes() == (tmp_path / "walk.png").read_bytes()
    path.write(tmp_path / "ours%d.obj")
    assert (tmp_path / "ours2.obj").read_bytes() == (tmp_path / "walk2.obj").read_bytes()

    from_arrays = shapespace.interpolate([poses[0], poses[1]], poses.faces, shapes=3).path
    np.testing.assert_array_equal(from_arrays.vertices, path.vertices)

    moved = shapespace.transfer(path, shapespace.read(tmp_path / "other0.obj")[0]).path
    theirs = shapespace.Path.read(tmp_path / "moved.path")
    np.testing.assert_array_equal(moved.vertices, theirs.vertices)


def test_a_path_has_the_poses_at_its_ends(poses, animal):
    path, summary = shapespace.interpolate(poses, animal.faces, shapes=3)
    assert summary.converged and path.converged and summary.termination == "converged"
    assert len(path) == 5 and path.poses == [0, 4]
    np.testing.assert_allclose(path.parameters, [0, 0.25, 0.5, 0.75, 1])
    np.testing.assert_allclose(path[0], poses[0], atol=1e-12)
    np.testing.assert_allclose(path[-1], poses[1], atol=1e-12)
    assert 1 <= summary.ratio < 1.2
    np.testing.assert_allclose(sum(summary.parts.values()), summary.energy)
    assert len(list(path)) == 5


def test_units_and_place_do_not_matter(poses, animal, rotation):
    options = {"shapes": 1, "tolerance": 1e-12, "max_iterations": 5000}
    here = shapespace.interpolate(poses, animal.faces, **options).path
    there = shapespace.interpolate(
        [1000 * pose @ rotation.T + [5, -7, 2] for pose in poses], animal.faces, **options
    ).path
    np.testing.assert_allclose(there[1], 1000 * here[1] @ rotation.T + [5, -7, 2], atol=0.02)


def test_threads_do_not_matter(poses, animal):
    results = []
    for threads in (1, 2):
        shapespace.set_threads(threads)
        assert shapespace.threads() == threads
        results.append(shapespace.interpolate(poses, animal.faces, shapes=3).path.vertices)
    shapespace.set_threads(0)
    np.testing.assert_array_equal(*results)


def test_a_frozen_metric_serves_several_paths(poses, animal):
    metric = shapespace.Metric(poses, animal.faces, preset="isometric", bending=1e-4)
    assert metric.options["bending"] == 1e-4 and metric.options["isometric"] == 1
    assert metric.options["strain"] == 0
    path = shapespace.interpolate(poses, animal.faces, metric=metric, shapes=1).path
    assert path.metric.unit == metric.unit
    options = shapespace.MetricOptions(preset="isometric", bending=1e-4)
    named = shapespace.interpolate(poses, animal.faces, metric=options, shapes=1).path
    np.testing.assert_array_equal(path.vertices, named.vertices)


def test_the_exponential_inverts_the_logarithm(animal, poses):
    start, end = animal.pose("stand"), animal.pose("stride")
    metric = shapespace.Metric([start, end], animal)
    velocity = shapespace.logarithm(metric, start, end, 8)
    reached = shapespace.exponential(metric, start, velocity, 8)
    goal = shapespace.interpolate([start, end], animal, metric=metric, shapes=7).path
    # The logarithm moves the end rigidly onto the start; edges tell nothing of that.
    edges = metric.edges
    lengths = [np.linalg.norm(v[edges[:, 0]] - v[edges[:, 1]], axis=1) for v in (reached, goal[-1])]
    np.testing.assert_allclose(*lengths, atol=1e-4)
    shot, summary = shapespace.shoot(metric, start, velocity, 8)
    np.testing.assert_array_equal(shot[-1], reached)
    assert summary.converged and len(summary.steps) == 8


def test_an_extrapolated_path_goes_on(path):
    longer, summary = shapespace.extrapolate(path, 2)
    assert len(longer) == len(path) + 2 and longer.extrapolated == 2
    np.testing.assert_array_equal(longer.vertices[: len(path)], path.vertices)
    assert summary.ending == "complete" and summary.integrator == "variational"
    assert longer.parameters[-1] > 1
    until, summary = shapespace.extrapolate(path, 2, stop_at_contact=True)
    assert summary.ending in ("complete", "contact")
    np.testing.assert_array_equal(until.vertices, longer.vertices[: len(until)])


def test_transport_keeps_lengths_and_is_linear(path):
    tangents = np.stack([path[1] - path[0], np.ones_like(path[0]) * [0, 0, 1e-3]])
    carried, summary = shapespace.transport(path, tangents)
    assert carried.shape == tangents.shape and summary.converged
    assert summary.last_norm[0] <= summary.first_norm[0] * (1 + 1e-9)
    assert summary.last_norm[0] > 0.8 * summary.first_norm[0]
    doubled, _ = shapespace.transport(path, 2 * tangents)
    np.testing.assert_allclose(doubled, 2 * carried, atol=1e-6 * np.abs(carried).max())


def test_the_metric_s_matrix_and_norm_agree(path):
    pytest.importorskip("scipy")
    metric, shape = path.metric, path[0]
    matrix = metric.matrix(shape)
    assert abs(matrix - matrix.T).max() < 1e-12 * abs(matrix).max()
    tangent = path[1] - path[0]
    square = tangent.ravel() @ (matrix @ tangent.ravel())
    np.testing.assert_allclose(np.sqrt(square), metric.norm(shape, tangent), rtol=1e-9)


def test_a_copy_that_is_moved_makes_the_moved_motion(path, rotation):
    moved = 2 * path[0] @ rotation.T + [1, 2, 3]
    result = shapespace.transfer(path, moved)
    assert result.hybrids is None and result.summary.converged
    np.testing.assert_allclose(result.path[-1], 2 * path[-1] @ rotation.T + [1, 2, 3], atol=2e-3)


def test_poses_are_transferred_with_hybrids(poses, animal):
    long = shapespace.skinned_body("quadruped", 1500, "long")
    result = shapespace.transfer_poses(poses, long.pose("sit"), animal.faces, hybrids=True)
    assert len(result.path) == 2 and len(result.hybrids) == 2
    assert rms(result.path[-1] - long.pose("stretch")) < 0.1
    same = shapespace.transfer_poses(poses, poses[0], animal.faces)
    assert rms(same.path[-1] - poses[1]) < 1e-2


def test_handles_are_met(animal):
    rest = animal.pose("stand")
    feet = rest[:, 1] < 0.1
    head = np.flatnonzero(rest[:, 1] > 1.4)
    handles = [
        shapespace.Handle(feet, name="feet"),
        shapespace.Handle(head, rest[head] + [0.1, 0, 0.2], name="head"),
    ]
    path, summary = shapespace.deform(rest, animal.faces, handles)
    np.testing.assert_allclose(path[-1][feet], rest[feet], atol=1e-9)
    np.testing.assert_allclose(path[-1][head], rest[head] + [0.1, 0, 0.2], atol=1e-9)
    assert [handle.name for handle in summary.handles] == ["feet", "head"]
    assert max(handle.residual_max for handle in summary.handles) < 1e-9
    deformer = shapespace.Deformer(rest, animal.faces, shapes=5)
    np.testing.assert_array_equal(deformer.deform(handles).path.vertices, path.vertices)
    assert deformer.deform(handles).summary.warm
    assert summary.intersections == 0
    assert np.isnan(deformer.deform(handles).summary.intersections)  # takes too long


def test_a_deformation_needs_handles(animal):
    for deform in (
        lambda: shapespace.deform(animal.pose("stand"), animal.faces, []),
        lambda: shapespace.Deformer(animal.pose("stand"), animal).deform([]),
    ):
        with pytest.raises(ValueError, match="handles"):
            deform()


def test_a_screw_motion_is_made(animal):
    rest = animal.pose("stand")
    everything = np.ones(len(rest), bool)
    turned = shapespace.deform(
        rest, animal, [shapespace.Handle(everything, axis=(0, 1, 0), angle=np.pi / 2)]
    ).path[-1]
    np.testing.assert_allclose(turned, rest[:, [2, 1, 0]] * [1, 1, -1], atol=1e-9)


def test_a_sound_pose_needs_no_repair_and_a_blend_does(animal, poses):
    sound = shapespace.repair(poses[0], poses[0], animal.faces)
    np.testing.assert_allclose(sound.path[-1], poses[0], atol=1e-6)
    blend = (poses[0] + poses[1]) / 2
    repaired = shapespace.repair(poses[0], blend, animal.faces).summary
    assert repaired.after.edge_rms < 0.5 * repaired.before.edge_rms


def test_a_template_is_fitted_to_itself(animal):
    rest = animal.pose("stand")
    chosen = np.unique([np.argmax(rest @ d) for d in itertools.product((-1, 0.3, 1), repeat=3)])
    markers = np.stack([chosen, chosen], axis=1)
    result = shapespace.correspond(rest, animal, rest + [5, 0, 0], animal.faces, markers)
    assert result.summary.converged
    assert rms(result.fitted - rest - [5, 0, 0]) < 0.02
    # A function that is linear in space is carried over as the same function.
    height = rest[:, 1]
    np.testing.assert_allclose(result.to_template(height), result.fitted[:, 1], atol=0.02)
    assert result.to_target(rest).shape == rest.shape
    carried = result.carry(shapespace.Path([result.fitted, result.fitted + [0, 0, 1]], _metric_of(
        result.fitted, animal)))
    np.testing.assert_allclose(carried[-1], rest + [5, 0, 1], atol=1e-6)


def _metric_of(shape, faces):
    return shapespace.Metric([shape], faces)


def test_distances_are_symmetric_and_obey_the_triangle_inequality(animal):
    names = ["stand", "stride", "sit"]
    shapes = [animal.pose(name) for name in names]
    coarse = shapespace.GeodesicOptions(shapes=3)
    distances = shapespace.distance_matrix(shapes, animal.faces, geodesic=coarse)
    np.testing.assert_array_equal(distances, distances.T)
    assert np.all(np.diag(distances) == 0)
    for i, j, k in itertools.permutations(range(3)):
        assert distances[i, j] <= 1.02 * (distances[i, k] + distances[k, j])

    space, summary = shapespace.explore(
        shapes, animal.faces, names=names, geodesic=coarse, depth=0
    )
    np.testing.assert_array_equal(space.distances, distances)
    assert space.names == names and summary.poses == 3
    middle = space.at(space.points[:2].mean(axis=0))
    np.testing.assert_allclose(middle, (space[0] + space[1]) / 2, atol=1e-9)
    assert len(space.along(space.points[[0, 1, 2]], 5)) == 5

    # Points outside of the hull are told from those inside.
    far = space.points.max(axis=0) + np.ptp(space.points)
    assert space.contains(space.points[:2].mean(axis=0)) and not space.contains(far)
    with pytest.warns(UserWarning, match="2 of the 3 points lie outside"):
        space.along([space.points[0], far], 3)
    with pytest.raises(shapespace.InvalidOptions, match="finite"):
        space.at([np.nan, 0])


def test_a_path_of_one_s_own(path, poses):
    mine = shapespace.Path(poses, path.metric, [0, 2])
    np.testing.assert_allclose(mine.vertices, poses, atol=1e-12)
    np.testing.assert_array_equal(mine.parameters, [0, 2])
    with pytest.raises(shapespace.MeshError):
        shapespace.Path(poses, path.metric, [0, 0])


def test_a_frozen_metric_lends_its_faces_to_no_other_mesh(poses, animal):
    metric = shapespace.Metric(poses, animal.faces, preset="strain")
    turned = np.roll(animal.faces, 1, axis=0)
    fewer = animal.faces[1:]
    for faces, difference in ((turned, "face 0 has other corners"), (fewer, "faces, the poses have")):
        with pytest.raises(shapespace.MeshError, match="frozen on another mesh.*" + difference):
            shapespace.interpolate(poses, faces, metric=metric, shapes=1)
        with pytest.raises(shapespace.MeshError, match="frozen on another mesh.*" + difference):
            shapespace.Path(shapespace.Poses(poses, faces), metric)
    # How polygons are cut depends on the poses, and is the metric's affair.
    quads = [[0, 1, 2, 3]]
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    dented = square * [[1, 1, 1], [0.3, 1, 1], [1, 1, 1], [1, 1, 1]]
    dented[1, 1] = 0.7
    frozen = shapespace.Metric([square, 2 * square], quads, preset="strain")
    assert len(shapespace.interpolate([dented, square], quads, metric=frozen, shapes=1).path) == 3


def test_a_path_at_other_times(path):
    again = path.at([0, 0.5, 1])
    np.testing.assert_array_equal(again[1], path.at([0.5])[0])
    for half in (0.5, np.float32(0.5), np.array(0.5)):
        np.testing.assert_array_equal(again[1], path.at(half))
    np.testing.assert_array_equal(path.at(1), again[-1])
    np.testing.assert_allclose(again[-1], path[-1], atol=1e-12)
    with pytest.raises(shapespace.InvalidOptions):
        path.at([0, 2])


def test_grounded_shapes_stand_on_the_ground(path):
    low = path.ground("y", 0.25).vertices[:, :, 1].min(axis=1)
    np.testing.assert_allclose(low, 0.25, atol=1e-12)


def test_figures_of_a_path(path):
    deviation = path.edge_deviation()
    assert deviation.shape == path.vertices.shape[:2]
    assert np.all(deviation[0] == 0) and deviation[-1].max() > 0
    assert path.quality().inner_shapes == 7
    assert path.intersections().shape == (len(path),)
    assert set(path.rigid_parts()) >= {-1, 0}
    error = shapespace.compare_shapes(path.metric, path[0], 1.1 * path[0])
    np.testing.assert_allclose([error.edge_rms, error.volume], [0.1, 1.1**3 - 1], rtol=1e-6)


def test_a_path_outlives_what_made_it(path):
    def temporary():
        return shapespace.Path(path.vertices, path.metric)

    metric = temporary().metric
    assert metric.unit == path.metric.unit
    assert temporary().at([0.5])[0].shape == path[0].shape
    assert temporary()._repr_html_().startswith("<img")


def test_textures_are_taken_from_the_mesh_s_own_folder(tmp_path):
    """By pickled paths too; from elsewhere on request only."""
    home = tmp_path / "home"
    home.mkdir()
    for name, x in (("a.obj", 1), ("b.obj", 2)):
        (home / name).write_text(
            f"v 0 0 0\nv {x} 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
            "mtllib s.mtl\nusemtl s\nf 1/1 2/2 3/3\n"
        )
    (tmp_path / "skin.png").write_bytes(b"\x89PNG\r\n\x1a\n a picture of one's own")
    (home / "skin.png").write_bytes((tmp_path / "skin.png").read_bytes())
    poses = shapespace.read(home / "a.obj", home / "b.obj")
    path = shapespace.interpolate(poses, metric="strain", shapes=1).path

    def has_texture(path, **options):
        path.write(tmp_path / "out" / "walk.glb", **options)
        return b"a picture" in (tmp_path / "out" / "walk.glb").read_bytes()

    (home / "s.mtl").write_text("newmtl s\nmap_Kd skin.png\n")
    assert has_texture(path) and has_texture(pickle.loads(pickle.dumps(path)))
    (home / "s.mtl").write_text("newmtl s\nmap_Kd ../skin.png\n")
    for one in (path, pickle.loads(pickle.dumps(path))):
        with pytest.warns(shapespace.MeshWarning, match="lies outside of the folder"):
            assert not has_texture(one)
        assert has_texture(one, allow_outside_files=True)


def jump(path):
    """The greatest jump of velocity at an inner pose, over the mean speed."""
    shapes, step = path.vertices, 1 / (len(path) - 1)
    way = sum(rms(b - a) for a, b in itertools.pairwise(shapes))
    after = [4 * shapes[k + 1] - 3 * shapes[k] - shapes[k + 2] for k in path.poses[1:-1]]
    before = [3 * shapes[k] - 4 * shapes[k - 1] + shapes[k - 2] for k in path.poses[1:-1]]
    return max(rms(a - b) for a, b in zip(after, before)) / (2 * step * way)


def test_a_spline_is_smooth_at_the_poses(poses, animal):
    three = [*poses, animal.pose("stretch")]
    options = {"shapes": 7, "tolerance": 1e-6}
    path, summary = shapespace.spline(three, animal.faces, **options)
    assert summary.converged and summary.smooth and path.smooth and summary.ends == "natural"
    assert jump(shapespace.interpolate(three, animal.faces, **options).path) > 0.5
    assert jump(path) < 0.1
    np.testing.assert_allclose(jump(path), summary.jump_after, rtol=0.2)
    for pose, k in zip(three, path.poses, strict=True):
        np.testing.assert_allclose(path[k], pose, atol=1e-9)
    cycle = shapespace.spline(three, animal.faces, ends="periodic", shapes=3).path
    np.testing.assert_allclose(cycle[-1], cycle[0], atol=1e-9)
    with pytest.raises(shapespace.InvalidOptions, match="times"):
        shapespace.spline(three, animal.faces, times=[0, 2, 1])


def test_parts_stand_where_the_poses_have_them(poses, animal):
    path = shapespace.spline([poses[0], poses[1], poses[0]], animal.faces, shapes=3).path
    foot = poses[0][:, 1] < 0.05
    top = [int(np.argmax(poses[0][:, 1]))]
    held, summary = shapespace.stand(path, [(foot, (0, 1)), (top, [(1, 2)])])
    assert summary.converged and summary.parts == 2 and summary.slide < 1e-12
    half = (path[0][foot] + path[4][foot]) / 2
    np.testing.assert_allclose(held[2][foot], half, atol=1e-9)
    assert rms(held[2] - path[2]) > 1e-4
    np.testing.assert_array_equal(held[4], path[4])
    with pytest.raises(shapespace.InvalidOptions, match="part 1: its intervals of poses"):
        shapespace.stand(path, [(foot, (0, 3))])


def test_an_average_keeps_lengths_and_says_how_good_it_is(poses, animal):
    mean, summary = shapespace.average(poses, animal.faces)
    assert summary.converged and summary.poses == 2 and summary.ambiguous_hinges == 0
    assert 1 <= summary.ratio < 1.1 and summary.edge_rms < 0.02
    weighted = shapespace.average(poses, animal.faces, weights=[0, 3], certify=False).shape
    np.testing.assert_allclose(weighted, poses[1], atol=1e-6)
    # Nearly the middle of the geodesic.
    middle = shapespace.interpolate(poses, animal.faces, shapes=1).path[1]
    metric = shapespace.Metric(poses, animal.faces)
    assert shapespace.compare_shapes(metric, middle, mean).edge_rms < 0.02
    with pytest.raises(shapespace.InvalidOptions, match="weights: must be 2, one for each pose"):
        shapespace.average(poses, animal.faces, weights=[1])


def test_a_path_without_contact_is_the_same_where_contact_is_avoided(poses, animal):
    free = shapespace.interpolate(poses, animal.faces, shapes=3)
    path, summary = shapespace.interpolate(poses, animal.faces, shapes=3, avoid_contact=True)
    assert summary.uncertified_segments == 0 and free.summary.uncertified_segments == -1
    np.testing.assert_array_equal(path.vertices, free.path.vertices)


def test_a_leg_that_a_handle_moves_pushes_another_aside(animal):
    rest = animal.pose("stand")
    low = rest[:, 1] < 0.1
    paw = np.flatnonzero(low & (rest[:, 0] < 0) & (rest[:, 2] < 0))
    handles = [
        shapespace.Handle(low & (rest[:, 0] > 0)),
        shapespace.Handle(rest[:, 1] > 1.25),
        shapespace.Handle(paw, rest[paw] + [0, 0.15, 1.1]),
    ]
    free = shapespace.deform(rest, animal.faces, handles)
    path, summary = shapespace.deform(rest, animal.faces, handles, avoid_contact=True)
    assert free.summary.uncertified_segments == -1 and summary.uncertified_segments == 0
    assert summary.contact_distance > 0 and summary.energy > free.summary.energy
    np.testing.assert_allclose(path[-1][paw], rest[paw] + [0, 0.15, 1.1], atol=1e-9)


def test_a_way_round_contact_leads_near_shapes(poses, animal):
    middle = shapespace.interpolate(poses, animal.faces, shapes=1).path.vertices[1]
    options = {"shapes": 3, "via": [middle]}
    with pytest.raises(shapespace.InvalidOptions, match="avoid_contact"):
        shapespace.interpolate(poses, animal.faces, **options)
    path, summary = shapespace.interpolate(poses, animal.faces, avoid_contact=True, **options)
    assert summary.uncertified_segments == 0 and summary.poses == 2
    assert path.vertices.shape == (5, *poses[0].shape)
    assert summary.ratio < 1.1


def test_a_body_moves_past_an_obstacle(poses, animal):
    size = np.ptp(poses[0], axis=0).max()
    way = np.array([0, 2 * size, 0])
    low = poses[0].min(axis=0)[2] - size
    floor = np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]]) * size + [0, 0, low]
    options = {"shapes": 1, "avoid_contact": True}
    faces = [[0, 1, 2, 3]]
    ends = [poses[0], poses[0] + way]
    for obstacle in ((floor, faces), shapespace.Poses([floor], faces)):
        path, summary = shapespace.interpolate(ends, animal.faces, obstacle=obstacle, **options)
        assert summary.uncertified_segments == 0
        np.testing.assert_allclose(path.vertices[1], poses[0] + way / 2, atol=1e-9 * size)
    with pytest.raises(TypeError, match="obstacle: must be Poses, or"):
        shapespace.interpolate(ends, animal.faces, obstacle=3, **options)
    with pytest.raises(shapespace.InvalidOptions, match="obstacle: is for"):
        shapespace.interpolate(ends, animal.faces, obstacle=(floor, faces))
