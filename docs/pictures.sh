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

# guide/deforming.md
"$bin/shape-body" quadruped --pose stand --output 'animal%d.obj'
cat > greet.json <<'EOF'
{"handles": [
  {"name": "standing feet", "fixed": true,
   "select": {"any": [{"box": {"low": [-1, 0, -1], "high": [1, 0.1, 0]}},
                      {"box": {"low": [0, 0, 0], "high": [1, 0.1, 1]}}]}},
  {"name": "head", "rotation": {"axis": [0, 1, 0], "degrees": -70},
   "select": {"box": {"low": [-1, 1.25, 0.5], "high": [1, 2, 2]}}},
  {"name": "paw", "position": [-0.15, 0.6, 0.75], "weight": 1,
   "select": {"box": {"low": [-1, 0, 0], "high": [0, 0.1, 1]}}},
  {"name": "tail", "position": [-0.25, 1.15, -0.9], "select": {"vertices": [6354]}}
]}
EOF
"$bin/shape-deform" animal0.obj --handles greet.json --up y --output "$pictures/deforming.png"
"$bin/shape-body" bar --at 0 --output 'bar%d.obj'
cat > twist.json <<'EOF'
{"handles": [
  {"fixed": true, "select": {"halfspace": {"point": [-2.49, 0, 0], "normal": [-1, 0, 0]}}},
  {"rotation": {"axis": [1, 0, 0], "degrees": 360},
   "select": {"halfspace": {"point": [2.49, 0, 0], "normal": [1, 0, 0]}}}
]}
EOF
"$bin/shape-deform" bar0.obj --handles twist.json --volume 3 --output "$pictures/twist.png"
"$bin/shape-body" quadruped --pose stand,stretch,rear --output 'pose%d.obj'
"$bin/shape-interpolate" pose1.obj pose2.obj --isometric 0 --bending 0 --lambda 1 --shapes 1 \
  --output 'mean%d.obj'
"$bin/shape-deform" mean1.obj --repair pose0.obj --output mended.obj
"$bin/shape-interpolate" pose0.obj mean1.obj mended.obj --isometric 0 --bending 0 --lambda 1 \
  --shapes 1 --output compare.path
"$bin/shape-export" compare.path --at 0,0.5,1 --color deviation --up y \
  --title "sound, distorted, repaired" --output "$pictures/repair.png"

# file-formats.md
"$bin/shape-body" miura --output 'fold%d.obj'
"$bin/shape-interpolate" fold0.obj fold1.obj --bending 0 --shapes 7 --output fold.path
"$bin/shape-export" fold.path --frames 6 --output "$pictures/frames.png"

# guide/library.md: what the program there draws
"$bin/shape-body" tube --at 0,110 --output 'tube%d.obj'
"$bin/shape-interpolate" tube0.obj tube1.obj --output "$pictures/library.png"
