#!/bin/bash
# The version of CMakeLists.txt is that of the add-on, the viewer, the npm package, the citation and
# the Debian packages, and the number in the name of the Debian package of libraries is that of the
# libraries.
set -euo pipefail
cd "$1"
version=$(sed -nE 's/^project\(ShapeSpace VERSION ([0-9.]+).*/\1/p' CMakeLists.txt)
[[ -n $version ]] || { echo "versions: CMakeLists.txt names no version" >&2 && exit 1; }
failed=0
expect() {
  if ! grep -qF -- "$2" "$1"; then
    echo "versions: CMakeLists.txt has $version, but $1 has no line '$2'" >&2
    failed=1
  fi
}
expect blender/shapespace_addon/blender_manifest.toml "version = \"$version\""
expect blender/shapespace_addon/__init__.py "\"version\": (${version//./, })"
expect tools/viewer/package.json "\"version\": \"$version\""
expect javascript/package.json "\"version\": \"$version\""
expect CITATION.cff "version: $version"
abi=$(sed -nE 's/^set\(abi ([0-9]+)\)$/\1/p' CMakeLists.txt)
if [[ -z $abi ]] || ! grep -qx "Package: libshapespace$abi" debian/control; then
  echo "versions: CMakeLists.txt has abi '$abi', but debian/control has no libshapespace$abi" >&2
  failed=1
fi
# The newest entry comes first.
if [[ $(head -1 debian/changelog) != "shapespace ($version-"* ]]; then
  echo "versions: debian/changelog begins with '$(head -1 debian/changelog)', not with $version" >&2
  failed=1
fi
exit $failed
