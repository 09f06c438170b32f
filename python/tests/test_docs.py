"""The programs of the documentation run as they are printed."""

import importlib.metadata
import pathlib
import re
import subprocess
import sys

import pytest

import shapespace

PROJECT = pathlib.Path(__file__).resolve().parents[2]
# Pages with programs, and a file that these write, if they write one.
PAGES = {
    "docs/guide/python.md": "walk.png",
    "docs/guide/python-more.md": None,
    "docs/guide/features.md": "area.path",
}


def snippets(page):
    """All programs but those that follow a comment with the reason for which they are not run."""
    text = (PROJECT / page).read_text(encoding="utf-8")
    found = re.findall(r"^(<!-- example: .* -->\n)?```python\n(.*?)^```", text, re.M | re.S)
    return [program for reason, program in found if not reason]


@pytest.mark.parametrize("page", PAGES)
def test_snippets_of_a_page_run_one_after_the_other(page, tmp_path, monkeypatch):
    if "eigsh" in "".join(snippets(page)):
        pytest.importorskip("scipy")
    animal = shapespace.skinned_body("quadruped", 3000)
    for name, pose in (("a.obj", "sit"), ("b.obj", "stretch")):
        shapespace.write(tmp_path / name, animal.pose(pose), animal.faces)
    monkeypatch.chdir(tmp_path)
    assert snippets(page)
    names = {"__name__": "snippet"}
    for snippet in snippets(page):
        exec(compile(snippet, page, "exec"), names)
    if PAGES[page]:
        assert (tmp_path / PAGES[page]).exists()


def test_the_wheel_has_the_notices_of_what_it_contains():
    # Where the package is used from the build folder, there is no wheel.
    try:
        wheel = importlib.metadata.distribution("shapespace")
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("not installed from a wheel")
    assert "The shapespace authors" in wheel.read_text("licenses/LICENSE")
    notices = wheel.read_text("licenses/NOTICES")
    for owner in ("Niels Lohmann", "Syoyo Fujita", "Wenzel Jakob", "Google Inc.", "Yann Collet"):
        assert owner in notices
    for term in ("Permission is hereby granted", "Redistribution and use", "Mozilla Public"):
        assert term in notices


def test_the_example_draws_a_film_strip(animal, tmp_path):
    for i, pose in enumerate(("sit", "stretch")):
        shapespace.write(tmp_path / f"{i}.obj", animal.pose(pose), animal.faces)
    example = PROJECT / "python/examples/film_strip.py"
    command = [sys.executable, example, "0.obj", "1.obj", "strip.png"]
    subprocess.run(command, cwd=tmp_path, check=True)
    assert (tmp_path / "strip.png").stat().st_size > 10000
