#!/bin/bash
# Installs the Debian packages in a bare system and tries them as their users would:
#   tests/packages/debian.sh bookworm|trixie FOLDER
# FOLDER is where packaging/debian.sh put them. Measures how long it takes from apt to the README's
# picture, installs the rest and runs debian/tests. Needs root, debootstrap and 4 GB of disk.
set -euo pipefail

fail() {
  echo "debian.sh: $*" >&2
  exit 1
}

release=${1:-}
packages=${2:-}
project=$(cd "$(dirname "$0")/../.." && pwd)
. "$project/packaging/root.sh"
bare_system "$release"
number=$(cut -d . -f 1 "$root/etc/debian_version")
mkdir "$root/root/packages"
for name in shapespace libshapespace0 libshapespace-dev python3-shapespace shapespace-doc; do
  files=("$packages/${name}"_*"~deb$number"_*.deb)
  [[ ${#files[@]} == 1 && -f ${files[0]} ]] ||
    fail "'$packages' has not one package $name: packaging/debian.sh $release FOLDER builds it"
  cp "${files[0]}" "$root/root/packages"
done

in_packages() { inside "$root" "$1" /root/packages; }
apt='apt-get -q install -y --no-install-recommends'
in_packages 'apt-get -q update' >"$work/apt.log" || fail "$(tail -3 "$work/apt.log")"

# From apt to the README's picture, with what apt recommends.
begin=$(date +%s)
in_packages 'apt-get -q install -y ./shapespace_*.deb ./libshapespace0_*.deb' >"$work/apt.log" 2>&1 ||
  fail "$release: the tools cannot be installed: $(tail -5 "$work/apt.log")"
installed=$(date +%s)
in_packages "shape-body quadruped --pose sit,stretch --output /root/pose%d.obj &&
  shape-interpolate /root/pose0.obj /root/pose1.obj --shapes 15 --output /root/path.png"
end=$(date +%s)
[[ $(head -c 8 "$root/root/path.png" | od -An -tx1 | tr -d ' \n') == 89504e470d0a1a0a ]] ||
  fail "$release: there is no picture"

# debian/tests, each with the packages that debian/tests/control names.
in_packages "$apt autopkgtest" >"$work/apt.log" 2>&1 || fail "$release: $(tail -5 "$work/apt.log")"
mkdir "$root/root/source"
git -C "$project" archive HEAD | tar -x -C "$root/root/source"
inside "$root" 'autopkgtest --no-built-binaries packages/*.deb source/ -- null' >"$work/tests.log" 2>&1 ||
  fail "$release: debian/tests: $(tail -50 "$work/tests.log")"
grep -E '^[a-z]+ +PASS$' "$work/tests.log" | sort -u
in_packages "$apt ./shapespace-doc_*.deb" >"$work/apt.log" 2>&1 ||
  fail "$release: $(tail -5 "$work/apt.log")"

inside "$root" "dpkg-query -W -f '\${Package} \${Version}: installed \${Installed-Size} kB\n' '*shapespace*'"
echo "debian.sh: Debian $(cat "$root/etc/debian_version") ($release): from apt to the picture" \
  "$((end - begin)) s, of which apt $((installed - begin)) s; debian/tests passed"
