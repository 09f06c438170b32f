"""Builds the wheel with CMake, and the source distribution: what pip calls (PEP 517). It needs nothing
but Python and CMake. Debian 12 has no scikit-build-core, which would do the same; Debian 13 has 0.11.

CMake builds in build/python of the project, which is kept, so that building again is quick.
Of pip's options --config-settings these are known:
  build-dir=FOLDER    takes another folder; one in which CMake has been before keeps its options
  platform=TAG        says for which systems the wheel is, such as manylinux_2_36_x86_64, where it was
                      linked for them (packaging/wheel.sh); without, it is for systems like this one
  licenses=FOLDER     adds the licences of what such a wheel contains, one file each
"""

import base64
import gzip
import hashlib
import io
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parent


def _version():
    text = (PROJECT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(ShapeSpace VERSION ([0-9.]+)", text).group(1)


def _metadata(settings):
    # A wheel that comes with licences is linked without SuiteSparse.
    license_ = "BSD-3-Clause; the built module links GPL-2.0-or-later parts of SuiteSparse"
    if "licenses" in settings:
        license_ = "BSD-3-Clause; libraries in the module are under other permissive licences"
    return (
        "Metadata-Version: 2.1\n"
        "Name: shapespace\n"
        f"Version: {_version()}\n"
        "Summary: Geodesics between poses of a mesh\n"
        f"License: {license_}\n"
        "Requires-Python: >=3.9\n"
        "Requires-Dist: numpy\n"
        "Description-Content-Type: text/markdown\n\n"
        + (HERE / "README.md").read_text(encoding="utf-8")
    )


def _tag(settings):
    interpreter = "cp" + sysconfig.get_config_var("py_version_nodot")
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    platform = settings.get("platform", platform)
    return f"{interpreter}-{interpreter}-{platform}"


def _wheel_file(settings):
    return (
        "Wheel-Version: 1.0\nGenerator: shapespace\nRoot-Is-Purelib: false\n"
        f"Tag: {_tag(settings)}\n"
    )


def _run(command):
    print(" ".join(shlex.quote(str(word)) for word in command), flush=True)
    subprocess.run(command, check=True)


def _missing_packages():
    """Of the lists of Debian packages those that are not installed; none where there is no dpkg."""
    wanted = []
    for name in ("build.txt", "python.txt"):
        text = (PROJECT / "packaging/packages" / name).read_text(encoding="utf-8")
        wanted += re.sub("#.*", "", text).split()
    if not shutil.which("dpkg-query"):
        return []
    command = ["dpkg-query", "-W", "-f", "${Package} ${db:Status-Status}\n", *wanted]
    found = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    there = {line.split()[0] for line in found.stdout.splitlines() if line.endswith(" installed")}
    return [package for package in wanted if package not in there]


def _advice():
    """What to do where CMake does not find something."""
    missing = _missing_packages()
    if missing:
        return "These packages are missing: apt-get install " + " ".join(missing)
    return (
        "On Debian, these lists name the packages, which ./dev packages installs: "
        "packaging/packages/build.txt and python.txt"
    )


def _build_module(settings, target):
    """Builds the module into the folder `target`."""
    build = PROJECT / settings.get("build-dir", "build/python")
    command = ["cmake", "-S", PROJECT, "-B", build, "-DSHAPESPACE_BUILD_PYTHON=ON"]
    if not (build / "CMakeCache.txt").exists():
        command += ["-DCMAKE_BUILD_TYPE=Release"]
        command += ["-DSHAPESPACE_BUILD_TOOLS=OFF", "-DSHAPESPACE_BUILD_TESTS=OFF"]
        command += ["-DCMAKE_UNITY_BUILD=ON"]  # is faster
    # FindPython and, before CMake 3.27, pybind11's own search go by these.
    command += [f"-DPython_EXECUTABLE={sys.executable}", f"-DPYTHON_EXECUTABLE={sys.executable}"]
    try:
        _run(command)
    except subprocess.CalledProcessError:
        sys.exit(f"shapespace: CMake did not find what it needs. {_advice()}")
    jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count()))
    _run(["cmake", "--build", build, "--target", "python_module", "--parallel", jobs])
    _run(["cmake", "--install", build, "--strip", "--component", "python", "--prefix", target])


def _record(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    settings = config_settings or {}
    info = f"shapespace-{_version()}.dist-info"
    files = {}
    with tempfile.TemporaryDirectory() as target:
        _build_module(settings, target)
        package = pathlib.Path(target) / "shapespace"
        for file in sorted(package.rglob("*")):
            if file.is_file():
                files[f"shapespace/{file.relative_to(package).as_posix()}"] = file.read_bytes()
    files[f"{info}/METADATA"] = _metadata(settings).encode()
    files[f"{info}/WHEEL"] = _wheel_file(settings).encode()
    for name in ("LICENSE", "NOTICES"):
        files[f"{info}/licenses/{name}"] = (PROJECT / name).read_bytes()
    if "licenses" in settings:
        for file in sorted(pathlib.Path(settings["licenses"]).iterdir()):
            files[f"{info}/licenses/{file.name}"] = file.read_bytes()
    record = "".join(_record(name, content) for name, content in files.items())
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()

    name = f"shapespace-{_version()}-{_tag(settings)}.whl"
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
    settings = config_settings or {}
    info = pathlib.Path(metadata_directory) / f"shapespace-{_version()}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(_metadata(settings), encoding="utf-8")
    (info / "WHEEL").write_text(_wheel_file(settings), encoding="utf-8")
    return info.name


def _sources():
    """The files of the project: of a clone what git tracks, else all but what building adds."""
    if (PROJECT / ".git").exists():
        listed = subprocess.run(
            ["git", "-C", PROJECT, "ls-files", "-z"], check=True, capture_output=True
        ).stdout.decode()
        names = set(filter(None, listed.split("\0")))
    else:
        names = {file.relative_to(PROJECT).as_posix() for file in PROJECT.rglob("*")}
        names = {name for name in names if not re.match("build/", name)}
        names = {name for name in names if not re.search("(^|/)(__pycache__|node_modules)/", name)}
        names -= {"PKG-INFO", "pyproject.toml"}
    names.add("tools/viewer/dist/viewer.html")  # if ./dev viewer has built it: that needs npm
    return sorted(name for name in names if (PROJECT / name).is_file())


def build_sdist(sdist_directory, config_settings=None):
    """The whole project, and beside it what pip asks for at the top of a source distribution."""
    folder = f"shapespace-{_version()}"
    # The time of all files, so that the same sources give the same bytes.
    time = int(os.environ.get("SOURCE_DATE_EPOCH", "315532800"))

    def add(archive, name, content, mode):
        entry = tarfile.TarInfo(f"{folder}/{name}")
        entry.size, entry.mode, entry.mtime = len(content), mode, time
        archive.addfile(entry, io.BytesIO(content))

    project = (HERE / "pyproject.toml").read_text(encoding="utf-8")
    project = project.replace('backend-path = ["."]', 'backend-path = ["python"]')
    project = project.replace('readme = "README.md"', 'readme = "python/README.md"')
    name = f"{folder}.tar.gz"
    with open(pathlib.Path(sdist_directory) / name, "wb") as file:
        with gzip.GzipFile(filename="", fileobj=file, mode="wb", mtime=time) as zipped:
            with tarfile.open(fileobj=zipped, mode="w", format=tarfile.PAX_FORMAT) as archive:
                add(archive, "PKG-INFO", _metadata({}).encode(), 0o644)
                add(archive, "pyproject.toml", project.encode(), 0o644)
                for source in _sources():
                    path = PROJECT / source
                    mode = 0o755 if os.access(path, os.X_OK) else 0o644
                    add(archive, source, path.read_bytes(), mode)
    return name
