"""What the build says where something is missing."""

import importlib.util
import pathlib

PROJECT = pathlib.Path(__file__).resolve().parents[2]


def test_the_build_names_the_debian_packages_that_are_missing(tmp_path, monkeypatch):
    spec = importlib.util.spec_from_file_location(
        "build_backend", PROJECT / "python/build_backend.py"
    )
    backend = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(backend)
    query = tmp_path / "dpkg-query"
    query.write_text(
        "#!/bin/sh\n"
        "shift 3\n"
        'for package; do case $package in\n'
        "  libceres-dev) echo no packages found matching libceres-dev >&2 ;;\n"
        '  pybind11-dev) echo "$package config-files" ;;\n'
        '  *) echo "$package installed" ;;\n'
        "esac; done\n"
    )
    query.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    assert backend._missing_packages() == ["libceres-dev", "pybind11-dev"]
    assert "apt-get install libceres-dev pybind11-dev" in backend._advice()
    monkeypatch.setenv("PATH", str(tmp_path / "nothing"))
    assert backend._missing_packages() == [] and "build.txt" in backend._advice()
