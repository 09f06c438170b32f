#!/bin/bash
# Has TinyUSDZ, a reader of USD from the npm registry, read a .usda that shape-interpolate writes, and
# compares all shapes with those of the frames in OBJ. Neither Debian's Blender nor any other Debian
# package reads USD. Usage: run.sh [BIN], the folder of the tools. Needs node and npm.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
bin=$(cd "${1:-$here/../../build/release/bin}" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cd "$work"
"$bin/shape-body" quadruped --triangles 1500 --pose stand,sit --output 'pose%d.obj' >/dev/null
"$bin/shape-interpolate" pose0.obj pose1.obj --shapes 5 --up y --unit 0.01 --color deviation \
  --output 'walk.usda,%03d.obj' >/dev/null 2>&1

npm install --silent --no-fund --no-audit --prefix "$work" tinyusdz@0.9.0-rc10 three@0.180.0
cp "$here/read.mjs" "$work"
node read.mjs walk.usda 00?.obj
