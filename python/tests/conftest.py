import os
import pathlib
import shutil

import numpy as np
import pytest

import shapespace

PROJECT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def animal():
    """A quadruped of some 750 vertices."""
    return shapespace.skinned_body("quadruped", 1500)


@pytest.fixture(scope="session")
def poses(animal):
    return [animal.pose("sit"), animal.pose("stretch")]


@pytest.fixture(scope="session")
def path(poses, animal):
    return shapespace.interpolate(poses, animal.faces, shapes=7).path


@pytest.fixture(scope="session")
def tool():
    """Runs a tool of the command line, and skips where there is none."""
    import subprocess

    folder = pathlib.Path(os.environ.get("SHAPESPACE_BIN", PROJECT / "build/release/bin"))

    def run(name, *arguments, cwd):
        program = shutil.which(name, path=str(folder))
        if program is None:
            pytest.skip(f"no {name} in {folder}: name the folder of the tools in SHAPESPACE_BIN")
        subprocess.run(
            [program, *map(str, arguments)], cwd=cwd, check=True, stdout=subprocess.DEVNULL
        )

    return run


@pytest.fixture
def rotation():
    """A rotation about no axis of coordinates."""
    q, _ = np.linalg.qr(np.array([[1.0, 2, 3], [0, 1, 4], [5, 6, 1]]))
    return q * np.sign(np.linalg.det(q))
