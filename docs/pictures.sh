#!/bin/sh
# Draws every picture of the documentation again. Run it after ./dev build.
set -eu
cd "$(dirname "$0")/.."
bin=$PWD/build/release/bin
pictures=$PWD/docs/pictures
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# README, guide/first-path.md
"$bin/shape-body" quadruped --pose sit,stretch --output 'animal%d.obj'
"$bin/shape-interpolate" animal0.obj animal1.obj --shapes 15 \
  --output "walk.path,$pictures/first-path.png"

# guide/metrics.md: Figure 2 of the paper with a body of ours
for metric in isometric rigid paper; do
  "$bin/shape-interpolate" animal0.obj animal1.obj --metric $metric --shapes 15 \
    --title "--metric $metric" --output $metric.path
  "$bin/shape-export" $metric.path --frames 7 --title "--metric $metric" \
    --output "$pictures/metric-$metric.png"
done

# guide/report.md
"$bin/shape-export" walk.path --frames 7 --color deviation --output "$pictures/deviation.png"
"$bin/shape-export" walk.path --frames 4 --color parts --output "$pictures/parts.png"

# guide/going-on.md
"$bin/shape-body" quadruped --pose stand,rear --output 'rise%d.obj'
"$bin/shape-extrapolate" rise0.obj rise1.obj --shapes 7 --steps 8 --output "$pictures/going-on.png"

# guide/transfer.md
"$bin/shape-body" quadruped --pose stand,rear,stride --output 'pose%d.obj'
"$bin/shape-body" quadruped --pose stand --proportions long --output 'other%d.obj'
"$bin/shape-transfer" pose0.obj pose1.obj pose2.obj --target other0.obj \
  --output "$pictures/transfer.png" --hybrids "$pictures/hybrids.png"

# file-formats.md
"$bin/shape-body" miura --output 'fold%d.obj'
"$bin/shape-interpolate" fold0.obj fold1.obj --bending 0 --shapes 7 --output fold.path
"$bin/shape-export" fold.path --frames 6 --output "$pictures/frames.png"

# guide/library.md: what the program there draws
"$bin/shape-body" tube --at 0,110 --output 'tube%d.obj'
"$bin/shape-interpolate" tube0.obj tube1.obj --output "$pictures/library.png"
