"""packaging/audit_wheel.py finds what keeps a wheel from running elsewhere."""

import pathlib
import shutil
import subprocess
import sys
import zipfile

import pytest
import shapespace._core

AUDIT = pathlib.Path(__file__).resolve().parents[2] / "packaging" / "audit_wheel.py"
pytestmark = pytest.mark.skipif(not shutil.which("readelf"), reason="needs binutils")


def audit(folder, tag):
    """What is said of the module that is being tested, as a wheel of this tag."""
    wheel = folder / f"shapespace-0.1.0-cp311-cp311-{tag}.whl"
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.write(shapespace._core.__file__, "shapespace/_core.so")
    return subprocess.run([sys.executable, AUDIT, wheel], capture_output=True, text=True)


def test_a_module_that_needs_libraries_of_the_system_is_refused(tmp_path):
    result = audit(tmp_path, "manylinux_2_36_x86_64")
    assert result.returncode != 0
    assert "needs libembree" in result.stderr


def test_a_wheel_for_this_system_alone_is_refused(tmp_path):
    assert "for this system alone" in audit(tmp_path, "linux_x86_64").stderr


def test_a_wheel_whose_tag_is_too_old_is_refused(tmp_path):
    assert "needs glibc 2." in audit(tmp_path, "manylinux_2_5_x86_64").stderr
