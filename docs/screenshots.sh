#!/bin/bash
# Makes every picture of the documentation that shows a page. Run it after ./dev build; needs node,
# npm and Chromium. The other pictures are made by pictures.sh.
set -euo pipefail
cd "$(dirname "$0")/.."
bin=$PWD/build/release/bin
root=$PWD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
npm install --silent --no-fund --no-audit --prefix "$work" playwright-core@1.55.0
cp tests/viewer/browser.mjs docs/screenshots.mjs "$work"
cd "$work"

# guide/viewing.md
"$bin/shape-body" quadruped --pose sit,stretch --output 'animal%d.obj'
"$bin/shape-interpolate" animal0.obj animal1.obj --output walk.path
"$bin/shape-interpolate" animal0.obj animal1.obj --metric rigid --output rigid.path
"$bin/shape-view" walk.path --output walk.html
"$bin/shape-view" walk.path rigid.path --output two.html

"$bin/shape-body" quadruped --pose stride,pass,other_stride,other_pass --output 'step%d.obj'
"$bin/shape-interpolate" step?.obj step0.obj --output chain.path
"$bin/shape-interpolate" step?.obj --spline periodic --output spline.path
"$bin/shape-view" chain.path spline.path --output smooth.html

"$bin/shape-body" quadruped --pose stand,stride,sit,stretch,rear --output 'pose%d.obj'
"$bin/shape-explore" pose?.obj --output poses.space
"$bin/shape-view" poses.space --output space.html

"$bin/shape-body" quadruped --triangles 3000 --pose stand --output 'cat%d.obj'
"$bin/shape-body" quadruped --triangles 5000 --pose stand --output 'lion%d.obj'
"$bin/shape-view" cat0.obj lion0.obj --output markers.html

# guide/bones.md
"$bin/shape-interpolate" pose0.obj pose2.obj pose3.obj pose4.obj pose1.obj --shapes 6 \
  --output bones.glb --bones 20 --bone_color weights
"$bin/shape-view" bones.glb --output bones.html

# guide/statistics.md
"$bin/shape-body" quadruped --triangles 3000 --random 8 --seed 1 --proportions long \
  --output 'long%d.obj' --table long.csv
"$bin/shape-body" quadruped --triangles 3000 --random 8 --seed 9 --proportions heavy \
  --output 'heavy%d.obj' --table heavy.csv
(echo file,leg_length && cat long.csv heavy.csv | grep -v ^pose | cut -d, -f1,8) >legs.csv
"$bin/shape-statistics" long?.obj heavy?.obj --modes 4 --output herd.modes
"$bin/shape-statistics" herd.modes --scalars legs.csv --output modes.html

node screenshots.mjs "$root/docs/pictures"
