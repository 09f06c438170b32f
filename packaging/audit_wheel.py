#!/usr/bin/env python3
"""Says whether what was built for other systems stands alone.

    audit_wheel.py WHEEL                  a wheel whose name ends with manylinux_X_Y_x86_64.whl
    audit_wheel.py --programs X.Y FILE... programs for systems with glibc X.Y or later

Each file must need no other library than those of the GNU C library and, for a module, those of GCC,
which PEP 600 and the list of auditwheel take for present on every such system; no newer symbol of the
GNU C library than the version said; and no folder of this system to look in. A module must export
nothing but the function by which Python starts it, so that no other module's copy of a library is taken
for its own. Needs readelf and nm (binutils).
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

# Of auditwheel's list for manylinux, those of the GNU C library, and those of GCC:
# https://github.com/pypa/auditwheel/blob/main/src/auditwheel/policy/manylinux-policy.json
C_LIBRARY = {"libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "librt.so.1",
             "ld-linux-x86-64.so.2"}
CXX_LIBRARY = {"libstdc++.so.6", "libgcc_s.so.1"}
LARGEST_WHEEL = 25e6  # bytes


def _run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def _findings(file, allowed, glibc):
    """What in this program or library keeps it from running elsewhere: sentences."""
    dynamic = _run("readelf", "--dynamic", "--wide", file)
    for library in re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic):
        if library not in allowed:
            yield f"needs {library}, which other systems may not have: link it statically"
    for folder in re.findall(r"\((?:RPATH|RUNPATH)\).*\[(.*)\]", dynamic):
        yield f"looks for libraries in {folder}: link without RPATH"
    versions = re.findall(r"GLIBC_(\d+)\.(\d+)", _run("readelf", "--version-info", "--wide", file))
    newest = max(((int(major), int(minor)) for major, minor in versions), default=(0, 0))
    if newest > glibc:
        yield f"needs glibc {newest[0]}.{newest[1]}: build it on an older system, or say so in the tag"


def _exports(file):
    symbols = _run("nm", "--dynamic", "--defined-only", "--format=posix", file)
    return [line.split()[0] for line in symbols.splitlines()]


def audit_programs(files, glibc):
    for file in files:
        for finding in _findings(file, C_LIBRARY, glibc):
            yield f"{file} {finding}"


def audit_wheel(wheel):
    tag = re.search(r"-manylinux_(\d+)_(\d+)_x86_64\.whl$", wheel.name)
    if not tag:
        yield "is tagged for this system alone, not for manylinux_X_Y_x86_64"
    glibc = (int(tag[1]), int(tag[2])) if tag else (3, 0)
    if wheel.stat().st_size > LARGEST_WHEEL:
        yield f"has {wheel.stat().st_size / 1e6:.1f} MB, more than {LARGEST_WHEEL / 1e6:.0f}"
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
        for file in sorted(pathlib.Path(folder).rglob("*.so*")):
            name = file.relative_to(folder)
            for finding in _findings(file, C_LIBRARY | CXX_LIBRARY, glibc):
                yield f"{name} {finding}"
            others = [symbol for symbol in _exports(file) if not symbol.startswith("PyInit_")]
            if others:
                yield f"{name} exports {others[0]} and {len(others) - 1} more: hide them"


def main(arguments):
    if len(arguments) > 2 and arguments[0] == "--programs":
        major, minor = arguments[1].split(".")
        findings = list(audit_programs(arguments[2:], (int(major), int(minor))))
    elif len(arguments) == 1:
        wheel = pathlib.Path(arguments[0])
        findings = [f"{wheel.name}: {finding}" for finding in audit_wheel(wheel)]
    else:
        sys.exit(__doc__)
    if findings:
        sys.exit("\n".join(f"audit_wheel.py: {finding}" for finding in findings))


if __name__ == "__main__":
    main(sys.argv[1:])
