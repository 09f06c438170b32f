"""Files in and out."""

import errno
import os

import numpy as np
import pytest

import shapespace


@pytest.mark.parametrize("name", ["mesh.obj", "mesh.ply"])
def test_a_mesh_reads_back_to_the_last_bit(name, animal, tmp_path):
    vertices = animal.pose("rear") / 3
    assert shapespace.write(tmp_path / name, vertices, animal.faces) == []
    again = shapespace.read(tmp_path / name)
    np.testing.assert_array_equal(again[0], vertices)
    np.testing.assert_array_equal(again.faces, animal.faces)
    assert again.names == [str(tmp_path / name)]


def test_polygons_and_materials_are_kept(tmp_path):
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nusemtl red\nf 1/1 2/1 3/1 4/1\n"
    (tmp_path / "square.obj").write_text(text)
    square = shapespace.read(str(tmp_path / "square.obj"))
    shapespace.write(tmp_path / "again.obj", 2 * square[0], square)
    written = (tmp_path / "again.obj").read_text()
    assert "usemtl red" in written and "f 1/1 2/1 3/1 4/1" in written
    np.testing.assert_array_equal(shapespace.read(tmp_path / "again.obj")[0], 2 * square[0])


def test_a_path_is_written_in_every_form(path, tmp_path):
    path.write(tmp_path / "walk.path")
    again = shapespace.Path.read(tmp_path / "walk.path")
    np.testing.assert_array_equal(again.vertices, path.vertices)
    assert "for Python: interpolate" in again.provenance

    path.write(tmp_path / "walk.png", title="a walk", frame_width=64)
    plain = (tmp_path / "walk.png").read_bytes()
    path.write(tmp_path / "walk.png", title="a walk", frame_width=64, color="parts")
    assert (tmp_path / "walk.png").read_bytes() != plain
    path.write(tmp_path / "walk.glb", duration=2.0, playback="loop", color="deviation")
    assert b"COLOR_0" in (tmp_path / "walk.glb").read_bytes()
    assert (tmp_path / "walk.png").read_bytes()[:4] == b"\x89PNG"
    assert (tmp_path / "walk.glb").read_bytes()[:4] == b"glTF"
    (tmp_path / "frames").mkdir()
    path.write(tmp_path / "frames" / "%03d.ply")
    assert len(list((tmp_path / "frames").iterdir())) == len(path)
    path.write(tmp_path / "frames" / "%03d.ply", color="deviation")
    first = (tmp_path / "frames" / "000.ply").read_bytes()
    assert b"property uchar red" in first
    with pytest.raises(ValueError, match="color"):
        path.write(tmp_path / "frames" / "%03d.ply", color="gold")
    for name in ("frames/%03d.ply", "walk.png", "walk.glb"):
        with pytest.raises(TypeError, match="'colour'.*did you mean 'color'"):
            path.write(tmp_path / name, colour="parts")
    with pytest.raises(shapespace.FileError, match="must end in"):
        path.write(tmp_path / "walk.tif")
    with pytest.raises(TypeError, match="'title'"):
        path.write(tmp_path / "walk.path", title="a walk")


def test_point_caches_hold_every_shape(path, tmp_path):
    path.write(tmp_path / "walk.pc2")
    cache = np.frombuffer((tmp_path / "walk.pc2").read_bytes()[32:], "<f4")
    np.testing.assert_array_equal(cache.reshape(path.vertices.shape), path.vertices.astype("f4"))
    path.write(tmp_path / "walk.mdd", fps=50)
    mdd = (tmp_path / "walk.mdd").read_bytes()
    frames, points = np.frombuffer(mdd[:8], ">i4")
    assert (frames, points) == path.vertices.shape[:2]
    times = np.frombuffer(mdd[8 : 8 + 4 * frames], ">f4")
    np.testing.assert_allclose(times, np.arange(frames) / 50, rtol=1e-6)
    with pytest.raises(TypeError, match="fps"):
        path.write(tmp_path / "walk.mdd", fps="fast")
    with pytest.raises(ValueError, match="fps"):
        path.write(tmp_path / "walk.mdd", fps=0)


def test_morph_targets_are_poses(path, tmp_path):
    path.write(tmp_path / "walk.glb")
    poses = shapespace.read(tmp_path / "walk.glb")
    assert len(poses) == len(path)
    assert poses.names[1] == "target 1"
    np.testing.assert_allclose(np.array(list(poses)), path.vertices, atol=1e-6)


def test_meshes_for_other_programs(animal, tmp_path):
    vertices = animal.pose("rear") / 3
    shapespace.write(tmp_path / "a.off", vertices, animal.faces)
    np.testing.assert_array_equal(shapespace.read(tmp_path / "a.off")[0], vertices)
    shapespace.write(tmp_path / "a.stl", vertices, animal.faces)
    again = shapespace.read(tmp_path / "a.stl")
    np.testing.assert_array_equal(
        again[0][again.faces], vertices.astype("f4")[animal.faces].astype(float)
    )


def test_what_cannot_be_read_is_named(tmp_path):
    with pytest.raises(OSError, match="missing.obj"):
        shapespace.read(tmp_path / "missing.obj")
    (tmp_path / "bad.obj").write_text("v 0 0 x\n")
    with pytest.raises(shapespace.FileError, match=r"bad.obj:1"):
        shapespace.read(tmp_path / "bad.obj")
    (tmp_path / "bad.path").write_text("nothing")
    with pytest.raises(shapespace.FileError, match="bad.path"):
        shapespace.Path.read(tmp_path / "bad.path")
    with pytest.raises(shapespace.FileError):
        shapespace.read()


def test_what_is_found_in_a_mesh_is_told(animal):
    assert {finding.severity for finding in shapespace.check(animal.pose("sit"), animal.faces)} == {
        "note"
    }
    torn = np.vstack([animal.faces, animal.faces[:1]])
    assert "fatal" not in {f.severity for f in shapespace.check(animal.pose("sit"), torn)}


def test_a_space_reads_back(animal, tmp_path):
    shapes = [animal.pose(name) for name in ("stand", "stride", "sit")]
    space = shapespace.explore(shapes, animal, depth=0, geodesic={"shapes": 1}).space
    space.write(tmp_path / "poses.space")
    again = shapespace.Space.read(tmp_path / "poses.space")
    np.testing.assert_array_equal(again.points, space.points)
    np.testing.assert_array_equal(again[1], space[1])


def test_notebooks_show_paths_and_pictures(path, animal):
    html = path._repr_html_()
    assert html.startswith("<img") and "data:image/png;base64,iVBOR" in html
    strip = shapespace.film_strip(path, frame_width=48)
    assert strip.png() == strip._repr_png_()
    pixels = np.asarray(strip)
    assert pixels.dtype == np.uint8 and pixels.shape[2] == 3
    # Something is drawn: not all of it has the colour of the background.
    assert (pixels != pixels[0, 0]).any(axis=2).mean() > 0.05
    coloured = np.asarray(
        shapespace.film_strip(path, frame_width=48, values=path.edge_deviation(), legend="edges")
    )
    assert coloured.shape != pixels.shape or (coloured != pixels).any()
    assert shapespace.film_strip([animal.pose("sit")], animal.faces).pixels.ndim == 3


def test_files_that_the_system_refuses_raise_what_python_raises(animal, tmp_path):
    with pytest.raises(FileNotFoundError, match="none.obj") as caught:
        shapespace.read(tmp_path / "none.obj")
    assert caught.value.errno == errno.ENOENT
    assert isinstance(caught.value, shapespace.FileError)
    assert isinstance(caught.value, shapespace.NoSuchFile)
    with pytest.raises(FileNotFoundError):
        shapespace.Path.read(tmp_path / "none.path")
    with pytest.raises(IsADirectoryError):
        shapespace.Path.read(tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(shapespace.FileError) as caught:
        shapespace.write(tmp_path / "file" / "a.obj", animal.pose("sit"), animal)
    assert caught.value.errno == errno.ENOTDIR


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read and write everything")
def test_files_that_are_not_permitted(tmp_path):
    (tmp_path / "a.path").write_text("x")
    (tmp_path / "a.path").chmod(0)
    with pytest.raises(PermissionError) as caught:
        shapespace.Path.read(tmp_path / "a.path")
    assert caught.value.errno == errno.EACCES
