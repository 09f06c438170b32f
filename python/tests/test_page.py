"""Pages for browsers and notebooks; skipped where the package has no viewer."""

import html
import pathlib

import pytest

import shapespace as ss

HAS_VIEWER = (pathlib.Path(ss.__file__).parent / "viewer.html").exists()
needs_viewer = pytest.mark.skipif(not HAS_VIEWER, reason="built without the viewer page")
SCENE = 'type="application/x-shapespace" data-scene'


@pytest.mark.skipif(HAS_VIEWER, reason="built with the viewer page")
def test_without_the_viewer_a_page_is_refused(path, tmp_path):
    for make in (path.show, lambda: path.write(tmp_path / "walk.html")):
        with pytest.raises(ss.Error, match="./dev viewer"):
            make()
    assert not (tmp_path / "walk.html").exists()


@needs_viewer
def test_a_path_is_written_and_shown_as_a_page(path, tmp_path):
    path.write(tmp_path / "walk.html")
    page = (tmp_path / "walk.html").read_text(encoding="utf-8")
    assert page.count(SCENE) == 1 and 'data-name="walk"' in page
    with pytest.raises(TypeError, match="'title'"):
        path.write(tmp_path / "walk.html", title="a walk")
    shown = path.show(height=300)._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and "height: 300px" in shown
    assert SCENE in html.unescape(shown)


@needs_viewer
def test_outside_notebooks_a_path_opens_in_the_browser(path, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    assert isinstance(path.show(), ss.Page)
    (address,) = opened
    assert address.startswith("file://") and address.endswith("/path.html")
    page = pathlib.Path(address[len("file://") :]).read_text(encoding="utf-8")
    assert page.count(SCENE) == 1


@pytest.fixture(autouse=True)
def no_browser(monkeypatch):
    monkeypatch.setattr("webbrowser.open", lambda address: None)


@needs_viewer
def test_two_paths_stand_side_by_side(path, tmp_path):
    ss.Page(path, path[::-1], names=["there", "back"]).write(tmp_path / "both.html")
    page = (tmp_path / "both.html").read_text(encoding="utf-8")
    assert page.count(SCENE) == 2 and 'data-name="back"' in page
    with pytest.raises(ss.InvalidOptions, match="one or two"):
        ss.Page(path, path, path)
    with pytest.raises(TypeError, match=r"things\[0\]: must be Path or Space, not ndarray"):
        ss.Page(path[0])
    with pytest.raises(ValueError, match="names"):
        ss.Page(path, names=["a", "b"])


@needs_viewer
def test_a_space_is_written_and_shown_as_a_page(animal, tmp_path):
    poses = [animal.pose(name) for name in ("stand", "stride", "sit")]
    space = ss.explore(poses, animal, depth=0, geodesic={"shapes": 1}).space
    space.write(tmp_path / "poses.html")
    assert 'data-name="poses"' in (tmp_path / "poses.html").read_text(encoding="utf-8")
    assert SCENE in html.unescape(space.show()._repr_html_())
    space.write(tmp_path / "poses.space")
    assert len(ss.Space.read(tmp_path / "poses.space")) == len(space)
