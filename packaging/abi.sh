#!/bin/bash
# The shared libraries with what abidiff needs to compare them with those of later versions,
# shapespace-X.Y.Z-abi.tar.xz:
#   packaging/abi.sh FOLDER
# Compiles in build/abi, which is kept; takes a quarter of an hour on two cores the first time.
set -euo pipefail
. "$(dirname "$0")/release_common.sh"
out=$(out_folder "${1:-}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# -O1 compiles faster than -O3; types and functions are the same. No folder of this
# machine is in the libraries, so that they are the same wherever they are built.
cmake -S "$project" -B "$project/build/abi" -G Ninja -DCMAKE_BUILD_TYPE=None \
  -DBUILD_SHARED_LIBS=ON -DSHAPESPACE_BUILD_TOOLS=OFF -DCMAKE_UNITY_BUILD=ON \
  -DCMAKE_CXX_FLAGS="-O1 -g -DNDEBUG -ffile-prefix-map=$project=." >"$work/configure.log" ||
  die "cmake: $(tail -n 5 "$work/configure.log")"
cmake --build "$project/build/abi"
name=shapespace-$version-abi
cmake --install "$project/build/abi" --prefix "$work/$name" >/dev/null
rm -rf "$work/$name"/{lib,share}/{cmake,pkgconfig,doc} "$work/$name"/lib/*/{cmake,pkgconfig}
pack "$out/$name.tar.xz" "$work" "$name"
