"""Arrays in and out: any type, any order of memory, and messages that name the argument."""

import gc
import pickle
import re
import warnings

import numpy as np
import pytest

import shapespace

TETRAHEDRON = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
SIDES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", ">f8", "i2", "i8", "u1", "longdouble"])
def test_any_type_of_number_is_taken(dtype):
    poses = shapespace.Poses([TETRAHEDRON.astype(dtype)], SIDES)
    assert poses[0].dtype == np.float64
    np.testing.assert_array_equal(poses[0], TETRAHEDRON)


@pytest.mark.parametrize(
    "laid_out",
    [
        np.asfortranarray,
        np.ndarray.tolist,
        lambda v: np.repeat(v, 2, axis=0)[::2],
        lambda v: np.hstack([v, v])[:, :3],
        lambda v: v[::-1].copy()[::-1],
        lambda v: np.lib.stride_tricks.as_strided(v, v.shape, v.strides, writeable=False),
    ],
)
def test_any_order_of_memory_is_taken(laid_out):
    vertices = np.arange(12.0).reshape(4, 3) ** 2
    poses = shapespace.Poses([laid_out(vertices)], SIDES)
    np.testing.assert_array_equal(poses[0], vertices)


@pytest.mark.parametrize("dtype", ["i1", "u8", ">i4", "i8"])
def test_any_type_of_index_is_taken(dtype):
    poses = shapespace.Poses([TETRAHEDRON], SIDES.astype(dtype))
    np.testing.assert_array_equal(poses.faces, SIDES)


def test_polygons_of_any_number_of_corners_are_kept():
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0.5, 0]]
    polygons = [[0, 1, 2, 3], [1, 4, 2]]
    poses = shapespace.Poses([square], polygons)
    assert poses.polygons == polygons
    assert len(poses.faces) == 3


def test_a_three_dimensional_array_is_several_poses():
    other = TETRAHEDRON + [[0, 0, 0], [0, 0, 0], [0, 0, 0], [0.5, 0, 0]]
    poses = shapespace.Poses(np.stack([TETRAHEDRON, other]), SIDES)
    assert len(poses) == 2
    np.testing.assert_array_equal(poses[-1], other)
    np.testing.assert_array_equal(poses.vertices[1], other)
    with pytest.raises(IndexError):
        poses[2]


def test_returned_arrays_own_their_memory():
    poses = shapespace.Poses([TETRAHEDRON], SIDES)
    vertices, faces = poses[0], poses.faces
    del poses
    gc.collect()
    assert vertices.flags.owndata and vertices.flags.writeable and faces.flags.owndata
    np.testing.assert_array_equal(vertices, TETRAHEDRON)


def test_what_is_returned_can_be_changed_without_consequences():
    poses = shapespace.Poses([TETRAHEDRON], SIDES)
    poses[0][:] = 7
    np.testing.assert_array_equal(poses[0], TETRAHEDRON)


def test_nothing_that_was_given_is_changed(poses, animal):
    given = [pose.copy() for pose in poses]
    shapespace.interpolate(poses, animal.faces, shapes=1)
    for one, other in zip(given, poses):
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize(
    "shapes, faces, error, words",
    [
        ([TETRAHEDRON.T], SIDES, ValueError, r"shapes\[0\].*3 x 4.*transpose"),
        (TETRAHEDRON, SIDES, ValueError, "shapes: .*put it in a list"),
        ([], SIDES, ValueError, "shapes: is empty"),
        ([TETRAHEDRON[0]], SIDES, ValueError, r"shapes\[0\]: .*not 3"),
        ([TETRAHEDRON[:, :2]], SIDES, ValueError, "4 x 2"),
        (7, SIDES, TypeError, "shapes: must be a list"),
        ([TETRAHEDRON.astype(complex)], SIDES, TypeError, r"shapes\[0\].*complex128"),
        ([TETRAHEDRON.astype(str)], SIDES, TypeError, r"shapes\[0\]"),
        ([np.full((4, 3), None)], SIDES, TypeError, "object"),
        ([TETRAHEDRON, TETRAHEDRON[:3]], SIDES, ValueError, r"shapes\[1\] .*3 .* 4"),
        ([TETRAHEDRON], SIDES + 0.5, TypeError, "faces: must be .* 0.5 is no"),
        ([TETRAHEDRON], SIDES + 1, ValueError, "faces: face 1 names vertex 4, .*counted from 0"),
        ([TETRAHEDRON], SIDES - 1, ValueError, "faces: face 0 names vertex -1"),
        ([TETRAHEDRON], SIDES[0], ValueError, "faces: "),
        ([TETRAHEDRON], SIDES[:, :2], ValueError, "faces: "),
        ([TETRAHEDRON], None, TypeError, "faces: are missing"),
        ([TETRAHEDRON], [[0, 1, 2], [0, 1]], ValueError, r"faces\[1\]"),
        ([TETRAHEDRON], [[0, 1, 2], "abc"], TypeError, r"faces\[1\]"),
    ],
)
def test_what_does_not_fit_is_named(shapes, faces, error, words):
    with pytest.raises(error, match=words):
        shapespace.Poses(shapes, faces)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_vertex_that_is_not_finite_is_named(bad):
    broken = TETRAHEDRON.copy()
    broken[2, 1] = bad
    with pytest.raises(shapespace.MeshError, match=r"shapes\[1\]: vertex 2 is not finite"):
        shapespace.Poses([TETRAHEDRON, broken], SIDES)


def test_a_mesh_that_a_file_would_be_refused_for_is_refused():
    fan = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    vertices = np.vstack([TETRAHEDRON, [[0.5, -1, -1]]])
    with pytest.raises(shapespace.MeshError, match="allow_nonmanifold"):
        shapespace.Poses([vertices], fan)
    with pytest.warns(shapespace.MeshWarning):
        assert shapespace.Poses([vertices], fan, allow_nonmanifold=True).warnings


def test_shapes_of_different_meshes_name_what_fits_one_onto_the_other(tmp_path):
    """By its name in Python, and not by those in C++ and of the tools."""
    bodies = [shapespace.body("tube", count) for count in (200, 300)]
    shapes, meshes = [body.pose(0) for body in bodies], []
    for i, (body, shape) in enumerate(zip(bodies, shapes)):
        meshes.append(shapespace.Poses([shape], body))
        shapespace.write(tmp_path / f"{i}.obj", shape, body)
    files = [str(tmp_path / f"{i}.obj") for i in range(2)]
    poses = shapespace.Poses([bodies[0].pose(angle) for angle in (0, 20)], bodies[0])
    path = shapespace.interpolate(poses, shapes=1).path
    for call in (
        lambda: shapespace.read(*files),
        lambda: shapespace.Poses(shapes, meshes[0]),
        lambda: shapespace.Poses(shapes, meshes[0].faces),
        lambda: shapespace.transfer(path, shapes[1]),
        lambda: shapespace.repair(meshes[0], shapes[1]),
    ):
        with pytest.raises((shapespace.MeshError, shapespace.MismatchError)) as refused:
            call()
        message = str(refused.value)
        assert str(len(shapes[0])) in message and str(len(shapes[1])) in message
        assert re.findall(r"[\w-]*[Cc]orrespond", message) == ["correspond"]


def test_mirror_images_are_refused_or_mirrored_or_taken_as_they_are():
    x, y = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9))
    dome = np.stack([x, y, -(x**2 + y**2) / 2], axis=-1).reshape(-1, 3)
    faces = [[k, k + 1, k + 10, k + 9] for k in range(71) if k % 9 < 8]
    flipped = dome * [-1, 1, 1]
    with pytest.raises(shapespace.MismatchError, match="mirror image"):
        shapespace.Poses([dome, flipped], faces)
    with pytest.warns(shapespace.MeshWarning, match="mirror image"):
        taken = shapespace.Poses([dome, flipped], faces, allow_mirrored=True)
    np.testing.assert_array_equal(taken[1], flipped)
    with pytest.warns(shapespace.MeshWarning, match="mirror image"):
        mirrored = shapespace.Poses([dome, flipped], faces, mirror="x")
    np.testing.assert_array_equal(mirrored[1], dome)


def test_components_that_stay_near_each_other_are_tied():
    near = np.vstack([TETRAHEDRON, TETRAHEDRON * 0.5 + [1.1, 0, 0]])
    apart = np.vstack([TETRAHEDRON, TETRAHEDRON * 0.5 + [5, 0, 0]])
    both = np.vstack([SIDES, np.asarray(SIDES) + 4])
    tied = shapespace.Poses([near, near], both)
    loose = shapespace.Poses([near, near], both, loose_components=True)
    assert len(tied.notes) == 1 and not loose.notes
    assert len(tied.edges) > len(loose.edges) == 12
    assert pickle.loads(pickle.dumps(tied)).notes == tied.notes
    assert len(shapespace.Poses([near, apart], both).edges) == 12
    assert len(shapespace.Poses([near, near], both, stiffeners=[[1, 5]]).edges) == 13


def test_anything_that_has_a_mesh_stands_for_its_faces(path, poses, animal):
    for mesh in (animal, path, path.metric, shapespace.Poses(poses, animal.faces)):
        made = shapespace.Poses(poses, mesh)
        np.testing.assert_array_equal(made.faces, animal.faces)
    with pytest.raises(shapespace.MeshError, match="vertices"):
        shapespace.Poses([TETRAHEDRON], path)


def test_vertices_may_be_chosen_by_truth_values(path):
    low = path[0][:, 1] < 0.1
    one = path.anchor(low)
    other = path.anchor(np.flatnonzero(low))
    np.testing.assert_array_equal(one.vertices, other.vertices)
    with pytest.raises(shapespace.MeshError, match="vertices: "):
        path.anchor(low[:-1])
    with pytest.raises(shapespace.MeshError, match="vertices names vertex"):
        path.anchor([len(low)])


def test_slices_of_poses_are_arrays_and_those_of_paths_are_paths(path, poses, animal):
    np.testing.assert_array_equal(shapespace.Poses(poses, animal)[::-1], [poses[1], poses[0]])
    np.testing.assert_array_equal(path[1:3].vertices, path.vertices[1:3])
    back = path[::-1]
    np.testing.assert_array_equal(back.vertices, path.vertices[::-1])
    np.testing.assert_allclose(back.parameters, path.parameters)
    assert back.poses == path.poses and path[:4].poses == [0] and path[4:].poses == [4]
    assert path[2:5].parameters[0] == 0
    with pytest.raises(IndexError):
        path[3:3]


def test_the_vertices_of_a_path_are_made_once_and_cannot_be_written(path):
    assert path.vertices is path.vertices
    np.testing.assert_array_equal(path.vertices[2], path[2])
    with pytest.raises(ValueError, match="read-only"):
        path.vertices[0, 0, 0] = 1


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda p, f: shapespace.extrapolate(list(p), 2), "faces: are missing"),
        (lambda p, f: shapespace.extrapolate(p, 2.5), "steps: must be int, not 2.5"),
        (lambda p, f: shapespace.extrapolate(p[:2], f), "steps: must be int"),
        (lambda p, f: shapespace.transfer(p.vertices, p[0]), "faces: are missing"),
        (lambda p, f: shapespace.correspond(p[0], f, p[1]), "the faces of target: are missing"),
        (lambda p, f: shapespace.correspond((p[0], f), (p[1], f), [], []), "no more"),
        (lambda p, f: shapespace.write("x.obj", p), "a Path"),
        (lambda p, f: shapespace.logarithm(p, p[0], p[1]), "metric: must be a Metric"),
        (lambda p, f: shapespace.deform(p[0], f, [0]), r"handles\[0\]: must be a Handle"),
        (lambda p, f: shapespace.interpolate(shapespace.Poses(p[:2], f), f), "faces: leave them"),
    ],
)
def test_what_is_of_another_class_is_named(path, animal, call, words):
    with pytest.raises(TypeError, match=words):
        call(path, animal.faces)


def test_a_handle_s_vertices_are_checked(animal):
    with pytest.raises(shapespace.MeshError, match="vertex -1, but they are counted from 0"):
        shapespace.Handle([-1])
    with pytest.raises(shapespace.InvalidOptions, match="1000000"):
        shapespace.deform(animal.pose("sit"), animal.faces, [shapespace.Handle([1000000])])


def test_poses_are_files_pairs_or_arrays(animal, poses, tmp_path):
    files = [tmp_path / "a.obj", str(tmp_path / "b.obj")]
    for file, pose in zip(files, poses):
        shapespace.write(file, pose, animal.faces)
    expected = shapespace.interpolate(poses, animal.faces, shapes=1).path.vertices
    pairs = [(pose, animal.faces) for pose in poses]
    for given in (files, pairs, shapespace.read(files), shapespace.read(*files)):
        np.testing.assert_allclose(shapespace.interpolate(given, shapes=1).path.vertices, expected)
    with pytest.raises(TypeError, match="faces"):
        shapespace.interpolate(files, animal.faces)
    with pytest.raises(ValueError, match=r"poses\[1\]"):
        shapespace.interpolate([(poses[0], animal.faces), (poses[1], animal.faces[::-1])])
    one = shapespace.correspond(files[0], (poses[1], animal.faces), max_iterations=1)
    assert one.fitted.shape == poses[0].shape


def test_poses_are_given_one_by_one_with_their_faces_last(animal, poses, tmp_path):
    F = animal.faces
    files = [tmp_path / f"{i}.obj" for i in range(2)]
    for file, pose in zip(files, poses):
        shapespace.write(file, (pose, F))
    expected = shapespace.interpolate(poses, F, shapes=1).path.vertices
    for given in ((*poses, F), ((poses[0], F), (poses[1], F)), files):
        np.testing.assert_array_equal(
            shapespace.interpolate(*given, shapes=1).path.vertices, expected
        )
    lengths = shapespace.distance_matrix(*poses, F, geodesic={"shapes": 1})
    assert lengths.shape == (2, 2)
    assert shapespace.intersections(poses[0], F).shape == (1,)
    with pytest.raises(shapespace.MeshError, match=r"poses\[1\] has"):
        shapespace.interpolate(poses[0], poses[1][1:], F)


def test_functions_take_meshes_in_all_forms(animal, poses, tmp_path):
    F, rest = animal.faces, animal.pose("stand")
    file = tmp_path / "rest.obj"
    shapespace.write(file, rest, F)
    top = rest[:, 1] > 1.4
    handles = [shapespace.Handle(~top), shapespace.Handle(top, translation=(0, 0.1, 0))]
    ball = {"ball": {"center": rest[0].tolist(), "radius": 0.5}}
    near = shapespace.select(rest, F, {"ball": {"centre": rest[0].tolist(), "radius": 0.5}})
    bent = shapespace.deform(rest, F, handles, shapes=1).path.vertices
    for mesh in ((rest, F), file, str(file), shapespace.read(file)):
        np.testing.assert_array_equal(shapespace.select(mesh, ball), near)
        np.testing.assert_array_equal(
            shapespace.deform(mesh, handles, shapes=1).path.vertices, bent
        )
    path = shapespace.interpolate(poses, F, shapes=1).path
    geodesic = {"shapes": 1}
    accurate = shapespace.interpolate(poses, F, shapes=1, tolerance=1e-6).path
    np.testing.assert_array_equal(
        shapespace.extrapolate(poses, F, 1, geodesic=geodesic).path.vertices,
        shapespace.extrapolate(accurate, 1).path.vertices,
    )
    moved = shapespace.transfer(poses, (poses[0], F), F, geodesic=geodesic).path
    np.testing.assert_allclose(moved.vertices, path.vertices, atol=1e-3)
    with pytest.raises(ValueError, match="target: has other faces"):
        shapespace.transfer(path, (poses[0], F[::-1]))
    assert shapespace.check((rest, F[1:])) == shapespace.check(rest, F[1:]) != []


def test_floats_that_are_whole_are_faces_and_counts(animal, poses):
    expected = shapespace.interpolate(poses, animal.faces, shapes=1).path.vertices
    for count in (1.0, np.float32(1)):
        path = shapespace.interpolate(poses, animal.faces.astype(float), shapes=count).path
        np.testing.assert_array_equal(path.vertices, expected)
    with pytest.raises(TypeError, match="faces: .* 0.5"):
        shapespace.interpolate(poses, animal.faces * 0.5)
    with pytest.raises(TypeError, match="faces"):
        shapespace.interpolate(poses, np.where(animal.faces == 3, np.inf, animal.faces))
    with pytest.raises(TypeError, match="shapes: must be int"):
        shapespace.interpolate(poses, animal.faces, shapes=1.5)


def test_messages_have_the_names_of_arguments(animal, poses):
    F = animal.faces
    broken = np.where(np.arange(len(poses[0]))[:, None] == 5, np.nan, poses[0])
    for call, words in (
        (lambda: shapespace.interpolate([poses[0], broken], F), r"poses\[1\]: vertex 5"),
        (lambda: shapespace.film_strip([broken], F), r"shapes\[0\]: vertex 5"),
        (lambda: shapespace.select(broken, F, "{}"), "vertices: vertex 5"),
        (lambda: shapespace.repair(broken, poses[0], F), "reference: vertex 5"),
        (lambda: shapespace.correspond((poses[0], F), (broken, F)), r"target\[0\]: vertex 5"),
        (lambda: shapespace.correspond((poses[0], F), (poses[1], F + 9999)), r"target\[1\]: face"),
    ):
        with pytest.raises(shapespace.MeshError, match=words):
            call()


def test_a_solve_that_did_not_converge_warns(animal, poses):
    with pytest.warns(UserWarning, match="max_iterations"):
        shapespace.interpolate(poses, animal.faces, shapes=3, max_iterations=1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        shapespace.interpolate(poses, animal.faces, shapes=1)
