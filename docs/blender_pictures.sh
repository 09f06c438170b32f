#!/bin/sh
# Makes the pictures of guide/blender.md, in Blender, and prints how long an update takes while an
# empty is dragged. Run it after ./dev blender and ./dev python; needs xvfb and OpenGL drivers
# (packaging/packages/blender.txt).
set -eu
cd "$(dirname "$0")/.."
bin=$PWD/build/release/bin
pictures=$PWD/docs/pictures
addon=$PWD/build/blender/shapespace.zip
script=$PWD/docs/blender_pictures.py
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/scripts"
export BLENDER_USER_SCRIPTS="$work/scripts"
cd "$work"
"$bin/shape-body" quadruped --pose sit,stretch --output 'animal%d.obj'
"$bin/shape-body" quadruped --triangles 10000 --pose stand --output 'standing%d.obj'
PATH=/usr/bin:$PATH  # Debian's Blender takes its Python's packages from where python3 is found
for window in motion dragging; do
  xvfb-run -a -s '-screen 0 1500x860x24' blender --factory-startup --enable-event-simulate \
    --window-geometry 0 0 1500 860 --python "$script" \
    -- "$window" "$addon" "$bin" "$work" "$pictures"
done
