#!/bin/bash
# Unpacks the packages of packaging/packages/aarch64.txt that end in :arm64, and what they depend on, into a
# folder:
#   tests/aarch64/sysroot.sh FOLDER
# They are of the release that runs here, from the mirror that apt uses here. Nothing is installed, and
# apt's and dpkg's own files stay as they are; so no root rights are needed. 200 MB, of which 37 are
# downloaded. A folder that was made of the same list is left alone.
set -euo pipefail

fail() {
  echo "sysroot.sh: $*" >&2
  exit 1
}

[[ $# == 1 ]] || fail "say which folder to make"
list=$(cd "$(dirname "$0")/../.." && pwd)/packaging/packages/aarch64.txt
mapfile -t packages < <(sed -n 's/^\([^#]*\):arm64.*/\1/p' "$list")
made_of=$(cat /etc/os-release "$list" "$0" | sha256sum)
if [[ -f $1/made-of && $(<"$1/made-of") == "$made_of" ]]; then exit; fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work"/{lists,archives}/partial

apt-get indextargets --format '$(ORIGIN) $(SITE) $(CODENAME)' | sort -u |
  sed -n 's|^Debian |deb [arch=arm64 signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] |p' |
  sed 's|$| main|' >"$work/sources.list"
[[ -s $work/sources.list ]] || fail "apt knows no Debian mirror: apt-get update"

# The graphics under OpenMesh's viewers (90 MB), which nothing here needs, count as installed.
printf '%s\n' 'Package: libopenscenegraph-dev' 'Status: install ok installed' 'Architecture: arm64' \
  'Maintainer: none' 'Version: 99' 'Description: not needed' >"$work/status"

apt() {
  apt-get -q -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Sandbox::User=root \
    -o Dir::Etc::sourcelist="$work/sources.list" -o Dir::Etc::sourceparts=- \
    -o Dir::State="$work" -o Dir::State::lists="$work/lists" -o Dir::State::status="$work/status" \
    -o Dir::Cache="$work" -o Dir::Cache::archives="$work/archives" "$@" >"$work/apt.log" 2>&1 ||
    fail "apt-get: $(grep '^E:' "$work/apt.log" || tail -3 "$work/apt.log")"
}
apt update
apt install -y --no-install-recommends --download-only "${packages[@]}"

rm -rf "$1"
mkdir -p "$1/usr/lib"
ln -s usr/lib "$1/lib"
root=$(cd "$1" && pwd)
for deb in "$work"/archives/*.deb; do
  dpkg-deb --fsys-tarfile "$deb" |
    tar -x -C "$root" --keep-directory-symlink --no-same-owner --exclude='./usr/share/doc*' \
      --exclude=./usr/share/man || fail "$(basename "$deb") could not be unpacked"
done
# What installing would have chosen among alternatives.
(cd "$root/usr/lib/aarch64-linux-gnu" && ln -s openblas-pthread/lib{blas,lapack,openblas}.so* .)
# Links to absolute paths would lead out of the folder.
find "$root" -type l -lname '/*' -printf '%p %l\n' |
  while read -r link target; do ln -sfnr "$root$target" "$link"; done
# So would the paths of libraries which the CMake package of Ceres says.
find "$root/usr/lib/aarch64-linux-gnu/cmake" -name 'CeresTargets*.cmake' \
  -exec sed -i "s|/usr/lib/aarch64-linux-gnu/lib|$root&|g" {} +
echo "$made_of" >"$root/made-of"
