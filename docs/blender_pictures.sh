#!/bin/sh
# Makes the pictures of guide/blender.md, in Blender. Run it after ./dev blender; needs xvfb and
# OpenGL drivers (debian-packages-blender.txt).
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
xvfb-run -a -s '-screen 0 1500x860x24' blender --factory-startup --enable-event-simulate \
  --window-geometry 0 0 1500 860 --python "$script" -- "$addon" "$bin" "$work" "$pictures"
