#!/bin/bash
# Has the Khronos glTF validator, from the npm registry, look at the .glb files named; without any,
# at those that the tests of a finished release build write. Needs node and npm.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if (($# == 0)); then
  mkdir "$work/glb"
  SHAPESPACE_GLB_DIR=$work/glb "$here/../../build/release/tests/output/output_test" \
    --gtest_filter='*Gltf*' >"$work/tests.log" || {
    cat "$work/tests.log"
    exit 1
  }
  set -- "$work"/glb/*.glb
fi

npm install --silent --no-fund --no-audit --prefix "$work" gltf-validator@2.0.0-dev.3.10
cp "$here/validate.mjs" "$work"
node "$work/validate.mjs" "$@"
