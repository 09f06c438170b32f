"""Builds the wheel with CMake: what pip calls (PEP 517). It needs nothing but Python and CMake.

CMake builds in build/python of the project, which is kept, so that building again is quick.
`--config-settings build-dir=FOLDER` takes another folder; one in which CMake has been before keeps
its options.
"""

import base64
import hashlib
import os
import pathlib
import re
import shlex
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parent


def _version():
    text = (PROJECT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(ShapeSpace VERSION ([0-9.]+)", text).group(1)


def _metadata():
    return (
        "Metadata-Version: 2.1\n"
        "Name: shapespace\n"
        f"Version: {_version()}\n"
        "Summary: Geodesics between poses of a mesh\n"
        "License: BSD-3-Clause; the built module links GPL-2.0-or-later parts of SuiteSparse\n"
        "Requires-Python: >=3.9\n"
        "Requires-Dist: numpy\n"
        "Description-Content-Type: text/markdown\n\n"
        + (HERE / "README.md").read_text(encoding="utf-8")
    )


def _tag():
    interpreter = "cp" + sysconfig.get_config_var("py_version_nodot")
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"{interpreter}-{interpreter}-{platform}"


def _wheel_file():
    return (
        "Wheel-Version: 1.0\nGenerator: shapespace\nRoot-Is-Purelib: false\n" f"Tag: {_tag()}\n"
    )


def _run(command):
    print(" ".join(shlex.quote(str(word)) for word in command), flush=True)
    subprocess.run(command, check=True)


def _build_module(settings, target):
    """Builds the module into the folder `target`."""
    settings = settings or {}
    build = PROJECT / settings.get("build-dir", "build/python")
    command = ["cmake", "-S", PROJECT, "-B", build, "-DSHAPESPACE_BUILD_PYTHON=ON"]
    if not (build / "CMakeCache.txt").exists():
        command += ["-DCMAKE_BUILD_TYPE=Release"]
        command += ["-DSHAPESPACE_BUILD_TOOLS=OFF", "-DSHAPESPACE_BUILD_TESTS=OFF"]
        command += ["-DCMAKE_UNITY_BUILD=ON"]  # is faster
    # FindPython and, before CMake 3.27, pybind11's own search go by these.
    command += [f"-DPython_EXECUTABLE={sys.executable}", f"-DPYTHON_EXECUTABLE={sys.executable}"]
    _run(command)
    jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count()))
    _run(["cmake", "--build", build, "--target", "python_module", "--parallel", jobs])
    _run(["cmake", "--install", build, "--strip", "--component", "python", "--prefix", target])


def _record(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    info = f"shapespace-{_version()}.dist-info"
    files = {}
    with tempfile.TemporaryDirectory() as target:
        _build_module(config_settings, target)
        package = pathlib.Path(target) / "shapespace"
        for file in sorted(package.rglob("*")):
            if file.is_file():
                files[f"shapespace/{file.relative_to(package).as_posix()}"] = file.read_bytes()
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/WHEEL"] = _wheel_file().encode()
    for name in ("LICENSE", "NOTICES"):
        files[f"{info}/licenses/{name}"] = (PROJECT / name).read_bytes()
    record = "".join(_record(name, content) for name, content in files.items())
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()

    name = f"shapespace-{_version()}-{_tag()}.whl"
    with zipfile.ZipFile(
        pathlib.Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED
    ) as wheel:
        for path, content in files.items():
            entry = zipfile.ZipInfo(path)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o100644 << 16
            wheel.writestr(entry, content)
    return name


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    info = pathlib.Path(metadata_directory) / f"shapespace-{_version()}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(_metadata(), encoding="utf-8")
    (info / "WHEEL").write_text(_wheel_file(), encoding="utf-8")
    return info.name


def build_sdist(sdist_directory, config_settings=None):
    raise NotImplementedError(
        "the module is built from the whole project: clone that, and pip install ./python there"
    )
