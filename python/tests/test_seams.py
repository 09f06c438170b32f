"""Vertices that are stored several times at seams are one point of the surface."""

import pickle
import warnings

import numpy as np
import pytest

import shapespace


def _cut_bar():
    """A bar as a soup of triangles, in two poses; and of each vertex that of the whole bar."""
    body = shapespace.body("bar", 300)
    poses = [body.pose(body.begin), body.pose(body.begin + 0.3 * (body.end - body.begin))]
    source = body.faces.reshape(-1)
    faces = np.arange(len(source)).reshape(-1, 3)
    return body, poses, source, faces


def _has_no_gap(shape, source):
    first = {v: shape[i] for i, v in reversed(list(enumerate(source)))}
    return all(np.array_equal(shape[i], first[v]) for i, v in enumerate(source))


def test_a_soup_moves_as_a_whole_and_keeps_its_vertices():
    body, poses, source, faces = _cut_bar()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cut = shapespace.Poses([pose[source] for pose in poses], faces)
    assert len(cut.notes) == 1
    assert str(len(source) - len(poses[0])) in cut.notes[0]
    np.testing.assert_array_equal(cut.faces, faces)
    path, _ = shapespace.interpolate(cut, shapes=3, tolerance=1e-9)
    whole, _ = shapespace.interpolate(shapespace.Poses(poses, body.faces), shapes=3, tolerance=1e-9)
    np.testing.assert_array_equal(path.faces, faces)
    for i in range(len(path)):
        assert _has_no_gap(path[i], source)
        np.testing.assert_allclose(path[i], whole[i][source], atol=1e-3 * np.ptp(poses[0]))


def test_seams_stay_open_if_they_are_to():
    _, poses, source, faces = _cut_bar()
    shapes = [pose[source] for pose in poses]
    cut = shapespace.Poses(shapes, faces, open_seams=True, loose_components=True)
    assert cut.notes == []
    assert len(cut.edges) == 3 * len(faces)


def test_files_are_read_alike(tmp_path):
    _, poses, source, faces = _cut_bar()
    shapespace.write(tmp_path / "cut.ply", poses[0][source], faces)
    assert len(shapespace.read(tmp_path / "cut.ply").notes) == 1
    cut = shapespace.read(tmp_path / "cut.ply", open_seams=True, loose_components=True)
    assert cut.notes == []


def test_stiffeners_do_not_open_seams():
    _, poses, source, faces = _cut_bar()
    shapes = [pose[source] for pose in poses]
    edges = len(shapespace.Poses(shapes, faces).edges)
    far = np.argmax(np.linalg.norm(shapes[0] - shapes[0][0], axis=1))
    assert len(shapespace.Poses(shapes, faces, stiffeners=[[0, far]]).edges) == edges + 1


def test_pickles_keep_seams_and_notes():
    _, poses, source, faces = _cut_bar()
    cut = shapespace.Poses([pose[source] for pose in poses], faces)
    again = pickle.loads(pickle.dumps(cut))
    assert again.notes == cut.notes
    np.testing.assert_array_equal(again.edges, cut.edges)


def test_a_metric_of_the_open_mesh_is_refused():
    _, poses, source, faces = _cut_bar()
    shapes = [pose[source] for pose in poses]
    metric = shapespace.Metric(shapespace.Poses(shapes, faces, open_seams=True))
    with pytest.raises(shapespace.MeshError, match="metric"):
        shapespace.interpolate(shapespace.Poses(shapes, faces), metric=metric)
