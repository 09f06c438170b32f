#!/bin/sh
# Draws every picture of the documentation again. Run it after ./dev build.
set -eu
cd "$(dirname "$0")/.."
bin=$PWD/build/release/bin
docs=$PWD/docs
pictures=$docs/pictures
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# README: what moves. Animated PNG is shown wherever PNG is, and there without .apng in its name.
"$bin/shape-body" quadruped --triangles 6000 --pose stand,rear,stride --output 'pose%d.obj'
"$bin/shape-extrapolate" pose0.obj pose1.obj pose2.obj --shapes 7 --steps 4 --output opening.path
"$bin/shape-export" opening.path --ground y=0 --output opening.apng
cp opening.apng "$pictures/opening.png"

# README: stills of three shapes each
still() { "$bin/shape-export" "$1" --frames 3 --up y --labels none --output "$2"; }
"$bin/shape-body" quadruped --pose sit,stretch --output 'animal%d.obj'
"$bin/shape-interpolate" animal0.obj animal1.obj --output still.path
still still.path "$pictures/still-between.png"

"$bin/shape-body" quadruped --triangles 6000 --pose stand --proportions long --output 'other%d.obj'
"$bin/shape-transfer" pose0.obj pose1.obj --target other0.obj --output still.path
still still.path "$pictures/still-transfer.png"

"$bin/shape-body" quadruped --triangles 4000 --pose sit --proportions heavy --output 'heavy%d.obj'
"$bin/shape-correspond" pose0.obj heavy0.obj --output fitted.ply
"$bin/shape-interpolate" pose0.obj fitted.ply --output still.path
still still.path "$pictures/still-bodies.png"

"$bin/shape-body" quadruped --triangles 3000 --random 8 --seed 1 --proportions long --output 'long%d.obj'
"$bin/shape-body" quadruped --triangles 3000 --random 8 --seed 9 --proportions heavy --output 'stout%d.obj'
"$bin/shape-statistics" long?.obj stout?.obj --modes 1 --output herd.modes
"$bin/shape-statistics" herd.modes --at -1.2 --output low.obj
"$bin/shape-statistics" herd.modes --at 1.2 --output high.obj
"$bin/shape-interpolate" low.obj high.obj --output still.path
still still.path "$pictures/still-modes.png"

cat > turn.json <<'EOF'
{"handles": [
  {"name": "feet", "fixed": true, "select": {"box": {"low": [-1, 0, -1], "high": [1, 0.1, 1]}}},
  {"name": "head", "rotation": {"axis": [0, 1, 0], "degrees": -80},
   "select": {"box": {"low": [-1, 1.25, 0.5], "high": [1, 2, 2]}}}
]}
EOF
"$bin/shape-deform" pose0.obj --handles turn.json --up y --output still.path
still still.path "$pictures/still-handles.png"

# README, guide/first-path.md
"$bin/shape-interpolate" animal0.obj animal1.obj --shapes 15 \
  --output "walk.path,$pictures/first-path.png"

# guide/going-on.md: feet that stay on the ground
"$bin/shape-body" quadruped --pose stride,rear --output 'step%d.obj'
"$bin/shape-interpolate" step0.obj step1.obj --output rear.path
"$bin/shape-export" rear.path --frames 5 --ground_line 0 --title "without --anchor" \
  --output "$pictures/slides.png"
"$bin/shape-export" rear.path --frames 5 --ground_line 0 --title "with --anchor" \
  --anchor '{"box": {"low": [-1, 0, -0.5], "high": [0, 0.1, -0.05]}}' \
  --output "$pictures/stands.png"

# guide/metrics.md: Figure 2 of the paper with a body of ours
for metric in strain isometric rigid paper; do
  "$bin/shape-interpolate" animal0.obj animal1.obj --metric $metric --shapes 15 \
    --title "--metric $metric" --output $metric.path
  "$bin/shape-export" $metric.path --frames 7 --title "--metric $metric" \
    --output "$pictures/metric-$metric.png"
done

# guide/report.md
"$bin/shape-export" walk.path --frames 7 --color deviation --output "$pictures/deviation.png"
"$bin/shape-export" walk.path --frames 4 --color parts --output "$pictures/parts.png"

# guide/smooth-motion.md
"$bin/shape-body" quadruped --pose stride,pass,other_stride,other_pass --output 'step%d.obj'
"$bin/shape-interpolate" step0.obj step1.obj step2.obj step3.obj --spline periodic --output cycle.path
"$bin/shape-export" cycle.path --frames 13 --output "$pictures/smooth-motion.png"

# guide/going-on.md
"$bin/shape-body" quadruped --pose stand,rear --output 'rise%d.obj'
"$bin/shape-extrapolate" rise0.obj rise1.obj --shapes 7 --steps 8 --output "$pictures/going-on.png"

# guide/transfer.md
"$bin/shape-body" quadruped --pose stand,rear,stride --output 'pose%d.obj'
"$bin/shape-body" quadruped --pose stand --proportions long --output 'other%d.obj'
"$bin/shape-transfer" pose0.obj pose1.obj pose2.obj --target other0.obj \
  --output "$pictures/transfer.png" --hybrids "$pictures/hybrids.png"
"$bin/shape-transport" pose0.obj pose1.obj pose2.obj --output "$pictures/transport.png"

# guide/contact.md
"$bin/shape-body" quadruped --pose stand --triangles 6000 --output 'animal%d.obj'
cat > step.json <<'EOF'
{"handles": [
  {"name": "paws", "fixed": true, "select": {"box": {"low": [0, 0, -1], "high": [1, 0.1, 1]}}},
  {"name": "head", "fixed": true, "select": {"box": {"low": [-1, 1.25, 0.5], "high": [1, 2, 2]}}},
  {"name": "hind paw", "translation": [0, 0.15, 1.1],
   "select": {"box": {"low": [-1, 0, -1], "high": [0, 0.1, 0]}}}
]}
EOF
"$bin/shape-deform" animal0.obj --handles step.json --up y --output "$pictures/deform-through.png"
"$bin/shape-deform" animal0.obj --handles step.json --up y --avoid_contact \
  --output "$pictures/deform-contact.png"

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
for balance in 0.001 0.01 0.1 0.5 1; do
  "$bin/shape-deform" animal0.obj --handles greet.json --balance $balance \
    --output "balance$balance.obj"
done
"$bin/shape-interpolate" balance0.001.obj balance0.01.obj balance0.1.obj balance0.5.obj \
  balance1.obj --shapes 1 --output balance.path
"$bin/shape-export" balance.path --at 0,.25,.5,.75,1 --up y \
  --labels "--balance 0.001,0.01 (default),0.1,0.5,1" --output "$pictures/balance.png"
"$bin/shape-body" bar --at 0 --output 'bar%d.obj'
cat > twist.json <<'EOF'
{"handles": [
  {"fixed": true, "select": {"halfspace": {"point": [-2.49, 0, 0], "normal": [-1, 0, 0]}}},
  {"rotation": {"axis": [1, 0, 0], "degrees": 360},
   "select": {"halfspace": {"point": [2.49, 0, 0], "normal": [1, 0, 0]}}}
]}
EOF
"$bin/shape-deform" bar0.obj --handles twist.json --volume 3 --output "$pictures/twist.png"

# guide/features.md
"$bin/shape-body" bar --triangles 1500 --at 0 --output 'bar%d.obj'
cat >bend.json <<'EOF'
{"handles": [
  {"rotation": {"axis": [0, 0, 1], "degrees": -75, "point": [-1.25, 0, 0]}, "translation": [0.5, 0, 0],
   "select": {"halfspace": {"point": [-2.49, 0, 0], "normal": [-1, 0, 0]}}},
  {"rotation": {"axis": [0, 0, 1], "degrees": 75, "point": [1.25, 0, 0]}, "translation": [-0.5, 0, 0],
   "select": {"halfspace": {"point": [2.49, 0, 0], "normal": [1, 0, 0]}}}
]}
EOF
awk '$1 == "v" { print ($2 > -1.2 && $2 < 1.2) ? 100 : 1 }' bar0.obj >stiff.txt
"$bin/shape-deform" bar0.obj --handles bend.json --up y --output "$pictures/stiffness-even.png"
"$bin/shape-deform" bar0.obj --handles bend.json --up y --stiffness stiff.txt \
  --output "$pictures/stiffness.png"

"$bin/shape-body" quadruped --pose stand,stretch,rear --output 'pose%d.obj'
"$bin/shape-interpolate" pose1.obj pose2.obj --strain 0 --bending 0 --lambda 1 --shapes 1 \
  --output 'mean%d.obj'
"$bin/shape-deform" mean1.obj --repair pose0.obj --output mended.obj
"$bin/shape-interpolate" pose0.obj mean1.obj mended.obj --strain 0 --bending 0 --lambda 1 \
  --shapes 1 --output compare.path
"$bin/shape-export" compare.path --at 0,0.5,1 --color deviation --up y \
  --labels sound,distorted,repaired --output "$pictures/repair.png"

# guide/correspondence.md: markers are vertices of both meshes that stand at one place in the usual
# proportions, in which the two would be one animal.
"$bin/shape-body" quadruped --triangles 3000 --pose stand,rear,stride --output 'template%d.obj'
"$bin/shape-body" quadruped --triangles 5000 --pose stand --output 'plain%d.obj'
"$bin/shape-body" quadruped --triangles 5000 --pose stand --proportions heavy --output 'heavy%d.obj'
"$bin/shape-body" quadruped --triangles 5000 --pose stride --proportions heavy \
  --output 'target%d.obj'
awk -f "$docs/markers.awk" template0.obj plain0.obj > markers.txt
"$bin/shape-correspond" template0.obj target0.obj --markers markers.txt \
  --output "$pictures/correspondence.png"
"$bin/shape-transfer" template0.obj template1.obj template2.obj --target heavy0.obj \
  --markers markers.txt --output "$pictures/correspondence-transfer.png"

# file-formats.md
"$bin/shape-body" miura --output 'fold%d.obj'
"$bin/shape-interpolate" fold0.obj fold1.obj --bending 0 --shapes 7 --output fold.path
"$bin/shape-export" fold.path --frames 6 --output "$pictures/frames.png"

# guide/statistics.md
"$bin/shape-body" quadruped --triangles 3000 --random 8 --seed 1 --proportions long \
  --output 'long%d.obj' --table long.csv
"$bin/shape-body" quadruped --triangles 3000 --random 8 --seed 9 --proportions heavy \
  --output 'heavy%d.obj' --table heavy.csv
"$bin/shape-statistics" long?.obj heavy?.obj --modes 2 --output "$pictures/modes.png"

# guide/library.md: what the program there draws
"$bin/shape-body" tube --at 0,110 --output 'tube%d.obj'
"$bin/shape-interpolate" tube0.obj tube1.obj --output "$pictures/library.png"

# guide/python.md: what the programs there draw, by the module that ./dev python has built
python=$pictures/../../build/python-venv/bin/python
[ -x "$python" ] || {
  echo "pictures.sh: guide/python.md's pictures are left as they are; ./dev python comes first" >&2
  exit 0
}
"$python" - "$pictures/../guide/python.md" <<'EOF'
import re, sys
for program in re.findall(r"^```python\n(.*?)^```", open(sys.argv[1]).read(), re.M | re.S):
    exec(program)
EOF
cp walk.png "$pictures/python-path.png"
cp bent.png "$pictures/python-deformed.png"
