#!/bin/bash
# Packs the tools, with manual pages and completion, for any x86-64 Linux with glibc 2.36 or later:
#   packaging/tools.sh OUTPUT_FOLDER
# makes shapespace-VERSION-linux-x86_64.tar.xz there, which is unpacked anywhere. The programs need
# nothing but the GNU C library; all else is linked statically, and nothing of it is under the GPL but
# GCC's own libraries, whose exception permits it. shape-explore is without MPI: one process. Two runs on
# the same sources give the same bytes.
set -euo pipefail
. "$(dirname "$0")/standalone.sh"

output=$(out_folder "${1:-}")
standalone_build bookworm
name=shapespace-$version-linux-x86_64
inside "$root" "rm -rf installed $name && cmake --install build --strip --prefix /root/installed >install.log &&
  mkdir -p $name/share && mv installed/bin $name/ &&
  mv installed/share/man installed/share/bash-completion installed/share/doc $name/share/ &&
  cp -r /opt/static/licenses $name/share/doc/shapespace/ &&
  cp /usr/share/doc/libstdc++6/copyright $name/share/doc/shapespace/licenses/gcc"
cat >"$root/root/$name/README" <<TEXT
shapespace $version: geodesics between poses of a mesh

bin/ has the programs; add it to PATH. Each explains itself with --help. For manual pages add share/man
to MANPATH, for completion in bash share to XDG_DATA_DIRS. For example:

  bin/shape-body quadruped --pose sit,stretch --output pose%d.obj
  bin/shape-interpolate pose0.obj pose1.obj --shapes 15 --output path.png,path.glb

The licence of shapespace is share/doc/shapespace/LICENSE; those of the libraries that the programs
contain are beside it in NOTICES and in licenses/.
TEXT
"$project/packaging/audit_wheel.py" --programs 2.36 "$root/root/$name/bin/"*
# The programs share most of their code: xz finds it again if it remembers all of them.
tar -C "$root/root" --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner \
  --mode=u+rw,go+r-w,a+X -c "$name" | xz -T1 --lzma2=preset=6,dict=256MiB >"$output/$name.tar.xz"
ls -l "$output/$name.tar.xz"
