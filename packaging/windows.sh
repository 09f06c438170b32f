#!/bin/bash
# The tools for Windows, as ./dev windows has built them:
#   packaging/windows.sh FOLDER
# makes shapespace-X.Y.Z-windows-x64.zip there. The programs need nothing but Windows 10, version 1903, or
# later; nothing that they contain is under the GPL but GCC's own libraries, whose exception permits it.
# Two runs on the same programs give the same bytes.
set -euo pipefail
. "$(dirname "$0")/release_common.sh"
out=$(out_folder "${1:-}")
programs=$project/build/windows/bin
[[ -e $programs/shape-interpolate.exe ]] || die "./dev windows has to build the programs first"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
name=shapespace-$version-windows-x64
mkdir -p "$work/$name/licenses"
for program in "$programs"/shape-*.exe; do
  x86_64-w64-mingw32-strip -o "$work/$name/$(basename "$program")" "$program"
done
# They link the libraries of Windows alone.
foreign=$(x86_64-w64-mingw32-objdump -p "$work/$name"/*.exe | sed -n 's/.*DLL Name: //p' | sort -u |
  grep -viE '^(advapi32|bcrypt|dbghelp|kernel32|msvcrt|shell32|shlwapi|user32|ws2_32)\.dll$') || true
[[ -z $foreign ]] || die "the programs need $foreign"
cp "$project"/{LICENSE,NOTICES} "$work/$name/"
cp "$project"/build/windows-libraries/licenses/* "$work/$name/licenses/"
cp /usr/share/doc/libstdc++6/copyright "$work/$name/licenses/gcc"
cp /usr/share/doc/mingw-w64-common/copyright "$work/$name/licenses/mingw-w64"
cat >"$work/$name/README.txt" <<TEXT
shapespace $version: geodesics between poses of a mesh

These are programs for the command line: in the folder's address bar in Explorer, type cmd and Enter.
Each explains itself with --help. For example:

  shape-body quadruped --pose sit,stretch --output pose%d.obj
  shape-interpolate pose0.obj pose1.obj --shapes 15 --output path.png,path.glb

In a .bat file, % is written as %%. Windows asks once whether programs that come from the network may
run. Blender's add-on takes them from this folder, which is set in its preferences.

The licence of shapespace is in LICENSE; those of the libraries that the programs contain are in NOTICES
and licenses.
TEXT
sed -i 's/$/\r/' "$work/$name/README.txt"
pack_zip "$out/$name.zip" "$work"
ls -l "$out/$name.zip"
