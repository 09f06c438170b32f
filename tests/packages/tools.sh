#!/bin/bash
# Tries the tools that packaging/tools.sh has packed on a bare Debian system in which nothing is
# installed: unpacks them and follows the README's example to a picture.
#   tests/packages/tools.sh bookworm|trixie ARCHIVE
# Needs root, debootstrap and network; takes the system away again.
set -euo pipefail

fail() {
  echo "tools.sh: $*" >&2
  exit 1
}

release=${1:?tools.sh: say which release: bookworm or trixie}
archive=${2:?tools.sh: say which archive}
source=$(cd "$(dirname "$0")/../.." && pwd)
. "$source/packaging/root.sh"
bare_system "$release"
before=$(date +%s.%N)
tar -x -C "$root/opt" -f "$archive"  # the bare system has no xz
name=$(basename "$archive" .tar.xz)
inside "$root" "export PATH=/opt/$name/bin:\$PATH &&
  shape-body quadruped --pose sit,stretch --output pose%d.obj &&
  shape-interpolate pose0.obj pose1.obj --shapes 15 --output path.png,path.glb,path.path --report report.txt &&
  printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2\nl 2 3\n' >graph0.obj && sed 's/1 1 0/0 1 0/' graph0.obj >graph1.obj &&
  shape-interpolate graph0.obj graph1.obj --output graph.png"  # whose edges are drawn in their own way
[[ $(head -c 8 "$root/root/path.png" | od -An -tx1 | tr -d ' \n') == 89504e470d0a1a0a ]] ||
  fail "$release: there is no picture"
grep -q '^Termination  *converged' "$root/root/report.txt" || fail "$release: the solver did not converge"
for program in "$root/opt/$name"/bin/*; do
  program=$(basename "$program")
  inside "$root" "/opt/$name/bin/$program --version" >"$work/version" || fail "$release: $program does not start"
  [[ -s $root/opt/$name/share/man/man1/$program.1 ]] || fail "$program has no manual page"
  [[ -s $root/opt/$name/share/bash-completion/completions/$program ]] || fail "$program has no completion"
done
echo "tools.sh: Debian $(cat "$root/etc/debian_version") ($release):" \
  "$(echo "$(date +%s.%N) $before" | awk '{ printf "%.1f", $1 - $2 }') s from the archive to the picture," \
  "$(du -sm "$root/opt/$name" | cut -f1) MB unpacked"
