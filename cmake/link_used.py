#!/usr/bin/python3
"""Links a program for Windows from the functions that it uses, and no others:

    cmake/link_used.py COMPILER ARGUMENT...

runs that command, as CMake's linker launcher (CMAKE_CXX_LINKER_LAUNCHER). By itself GNU's linker drops
no function that can throw an exception: its --gc-sections keeps all that tells how functions are unwound
(.pdata), and thereby every function, which makes programs half as large again. Here the first link keeps
none of that, and says by its map which functions are used; each further one keeps what belongs to the
functions that have been used so far, until no others come. Sections are told apart by the functions'
names, which -ffunction-sections gives them.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

ALL_KEPT = ("KEEP(*(.pdata*))", "KEEP(*(.xdata*))")


def default_script(compiler):
    linker = subprocess.run([compiler, "-print-prog-name=ld"], check=True, capture_output=True, text=True)
    said = subprocess.run([linker.stdout.strip(), "--verbose"], check=True, capture_output=True, text=True)
    script = said.stdout.split("=" * 50)[1]
    for kept in ALL_KEPT:
        if kept not in script:
            sys.exit(f"link_used.py: the linker's own script does not have {kept}: is this needed yet?")
        script = script.replace(kept, kept[len("KEEP(") : -1])
    return script


def used_functions(link_map):
    """The suffixes of the sections .text$NAME, .text.unlikely$NAME and the like in the linked program."""
    placed = link_map.partition("Linker script and memory map")[2]
    sections = re.findall(r"^ \.text([$.]\S+)\s+0x[0-9a-f]+\s+0x([0-9a-f]+) ", placed, re.MULTILINE)
    return {name for name, size in sections if int(size, 16) > 0}


def main():
    command = sys.argv[1:]
    script = default_script(command[0])
    known = set()
    with tempfile.TemporaryDirectory() as folder:
        link_map, kept_script = pathlib.Path(folder, "map"), pathlib.Path(folder, "script")
        while True:
            kept = "".join(f"KEEP(*(.pdata{name}))\n" for name in ["", *sorted(known)])
            kept_script.write_text(script.replace("*(.pdata*)", f"{kept}*(.pdata*)"), encoding="utf-8")
            linked = subprocess.run([*command, f"-Wl,-T,{kept_script}", f"-Wl,-Map,{link_map}"], check=False)
            if linked.returncode != 0:
                sys.exit(linked.returncode)
            used = used_functions(link_map.read_text(encoding="utf-8", errors="replace"))
            if used <= known:
                return
            known |= used


if __name__ == "__main__":
    main()
