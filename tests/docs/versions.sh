#!/bin/bash
# The version of CMakeLists.txt is that of the add-on, of the viewer and of the citation.
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
expect tools/viewer/package.json "\"version\": \"$version\""
expect CITATION.cff "version: $version"
exit $failed
