"""The notebooks among the examples run, and are stored with what they show."""

import base64
import json
import pathlib
import re
import struct
import sys

import numpy as np
import pytest

import shapespace as ss

EXAMPLES = pathlib.Path(__file__).resolve().parents[1] / "examples"
FILM = EXAMPLES / "from_files_to_film.ipynb"


def outputs_of(notebook):
    """Of every cell what it printed, and its pictures."""
    found = []
    for cell in notebook["cells"]:
        text, pictures = "", []
        for output in cell.get("outputs", []):
            assert output["output_type"] in ("stream", "execute_result")
            assert output.get("name", "stdout") == "stdout"  # no warnings
            text += "".join(output.get("text", ""))
            if "image/png" in output.get("data", {}):
                pictures.append(base64.b64decode(output["data"]["image/png"]))
        found.append((text, pictures))
    return found


def sizes_of(pictures):
    """Width and height in the headers of PNG files."""
    for picture in pictures:
        assert picture.startswith(b"\x89PNG")
    return [struct.unpack(">II", picture[16:24]) for picture in pictures]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The notebook after a run, and the folder of its files."""
    pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    folder = tmp_path_factory.mktemp("film")
    sys.path.insert(0, str(EXAMPLES))
    try:
        from execute import execute
    finally:
        sys.path.remove(str(EXAMPLES))
    return execute(FILM, folder), folder


def test_ten_cells_lead_from_files_to_a_film(run):
    notebook, folder = run
    assert len(notebook.cells) == 10
    for name in ("sit", "stand", "stretch"):
        assert (folder / f"{name}.obj").exists()

    path = ss.Path.read(folder / "film.path")
    assert path.smooth and path.poses == [0, 8, 16]
    given = ss.read(*(folder / f"{name}.obj" for name in ("sit", "stand", "stretch")))
    lengths = [np.linalg.norm(np.diff(shape[given.edges], axis=1), axis=2) for shape in given]
    for pose, expected in zip(path.poses, lengths):
        found = np.linalg.norm(np.diff(path[pose][given.edges], axis=1), axis=2)
        np.testing.assert_allclose(found, expected, rtol=1e-9)

    content = (folder / "film.glb").read_bytes()
    magic, version, length, size = struct.unpack("<4sIII", content[:16])
    assert (magic, version, length) == (b"glTF", 2, len(content))
    scene = json.loads(content[20 : 20 + size])
    times = scene["accessors"][scene["animations"][0]["samplers"][0]["input"]]
    assert times["max"] == [6.0]  # seconds
    assert len(scene["meshes"][0]["primitives"][0]["targets"]) >= len(path) - 1
    assert (folder / "film.png").read_bytes().startswith(b"\x89PNG")


def test_its_cells_show_what_they_say(run):
    outputs = outputs_of(run[0])
    numbers = [[float(n) for n in re.findall(r"-?\d+\.?\d*", text)] for text, _ in outputs]
    assert "converged: True" in outputs[4][0]
    ratio, deviation = numbers[4][:2]
    assert 1 <= ratio < 1.1 and 0 < deviation < 5
    plain, _, kept = numbers[6]  # per cent; the one between is the coefficient
    assert 0 < kept < plain / 4
    before, after = numbers[7]
    assert after < before / 2
    assert outputs[9][0].endswith("equal: True\n")
    for cell, frames in ((2, 3), (3, 5), (5, 5), (8, 4)):
        ((width, height),) = sizes_of(outputs[cell][1])
        assert width > 90 * frames and height > 90


def test_its_stored_outputs_are_those_of_a_run(run):
    stored = json.loads(FILM.read_text(encoding="utf-8"))
    for (text, pictures), (again, drawn) in zip(outputs_of(stored), outputs_of(run[0])):
        # Numbers may differ by rounding between processors.
        assert re.sub(r"[\d.]+", "#", text) == re.sub(r"[\d.]+", "#", again)
        assert sizes_of(pictures) == sizes_of(drawn)
    for stored_cell, cell in zip(stored["cells"], run[0].cells):
        assert stored_cell.get("execution_count") == cell.get("execution_count")


def test_what_is_stored_is_small_and_of_no_machine():
    text = FILM.read_text(encoding="utf-8")
    assert len(text) < 300_000
    without_pictures = re.sub(r'"image/png": "[^"]*"', "", text)
    assert not re.search(r"/(home|tmp|usr|root|work|Users)\b", without_pictures)
