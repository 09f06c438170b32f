#!/bin/sh
# Draws every picture of the documentation again: docs/pictures.sh, after ./dev build.
set -eu
cd "$(dirname "$0")/.."
bin=$PWD/build/release/bin
pictures=$PWD/docs/pictures
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

"$bin/shape-body" tube --at 0,110 --output 'tube%d.obj'
"$bin/shape-interpolate" tube0.obj tube1.obj --output "$pictures/tube.png"
