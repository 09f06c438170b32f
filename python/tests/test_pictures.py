"""Film strips: options that are Python's to pass on."""

import numpy as np
import pytest
import shapespace as ss


@pytest.fixture(scope="module")
def boxes():
    """A tetrahedron, and the same moved along x."""
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    return ss.Poses([vertices, vertices + [0.5, 0, 0]], faces)


def test_a_ground_line_shows_where_shapes_are(boxes):
    options = {"frame_width": 96, "view": (0, 0, 1), "up": (0, 1, 0)}
    centred = np.asarray(ss.film_strip(boxes, **options)).astype(int)
    assert np.array_equal(centred, np.asarray(ss.film_strip(boxes, ground_line=None, **options)))
    placed = np.asarray(ss.film_strip(boxes, ground_line=0.0, **options)).astype(int)

    def left(image, cell):
        width = image.shape[1] // 2
        part = image[:, cell * width : (cell + 1) * width]
        return np.nonzero((part[:, :, 2] > part[:, :, 0] + 40).any(axis=0))[0][0]

    assert left(centred, 0) == left(centred, 1)
    assert left(placed, 1) > left(placed, 0) + 15


def test_texts_are_unicode(boxes):
    with_umlaut = ss.film_strip(boxes, frame_width=48, title="Bär", labels=["α", "→"])
    without = ss.film_strip(boxes, frame_width=48, title="Bar", labels=["a", "->"])
    assert not np.array_equal(with_umlaut.pixels, without.pixels)


def test_wrong_types_are_named(boxes):
    with pytest.raises(TypeError, match="ground_line: must be float"):
        ss.film_strip(boxes, ground_line="y=0")
    with pytest.raises(ValueError, match="ground_line"):
        ss.film_strip(boxes, ground_line=float("nan"))


def test_a_path_is_written_as_a_film_and_as_pictures(path, tmp_path):
    path.write(tmp_path / "walk.gif", width=60, duration=0.2, playback="loop")
    path.write(tmp_path / "walk.apng", width=60, duration=0.2, title="a walk")
    path.write(tmp_path / "walk%d.png", width=60)
    assert (tmp_path / "walk.gif").read_bytes()[:6] == b"GIF89a"
    assert b"acTL" in (tmp_path / "walk.apng").read_bytes()
    assert len(list(tmp_path.glob("walk?.png"))) == len(path)
    with pytest.raises(ss.InvalidOptions, match="duration"):
        path.write(tmp_path / "walk.gif", duration=-1)
    with pytest.raises(TypeError, match="'duration'"):
        path.write(tmp_path / "walk%d.png", duration=1)


def test_a_motion_that_ends_where_it_begins_is_played_around(poses, animal, tmp_path):
    there = ss.interpolate(poses, animal.faces, shapes=1).path
    cycle = ss.Path([*there, there[1], there[0]], there.metric)
    for name in ("walk.glb", "walk.gif"):
        written = {}
        for playback in ("auto", "loop", "there_and_back"):
            cycle.write(tmp_path / name, playback=playback, duration=0.5)
            written[playback] = (tmp_path / name).read_bytes()
        cycle.write(tmp_path / name, duration=0.5)
        assert (tmp_path / name).read_bytes() == written["auto"] == written["loop"]
        assert written["loop"] != written["there_and_back"]
        there.write(tmp_path / name, duration=0.5)
        automatic = (tmp_path / name).read_bytes()
        there.write(tmp_path / name, duration=0.5, playback="there_and_back")
        assert (tmp_path / name).read_bytes() == automatic
