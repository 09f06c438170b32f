#!/bin/bash
# Looks at pages of shape-view in headless Chromium, drawn by software; first a release build with the
# viewer's page in it: ./dev viewer, ./dev build. With names of pages, says how fast these are instead.
# Needs node, npm and Chromium; installs chromium where there is none, on Debian as root.
# SHAPESPACE_SCREENSHOT_DIR: a folder for pictures of the pages.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
bin=$root/build/release/bin
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if ! command -v chromium >/dev/null; then
  apt-get -q update && apt-get -q install -y --no-install-recommends chromium
fi
npm install --silent --no-fund --no-audit --prefix "$work" \
  playwright-core@1.55.0 gltf-validator@2.0.0-dev.3.10 three@0.180.0
cp "$here"/*.mjs "$work"

if (($# > 0)); then
  exec node "$work/measure.mjs" "$@"
fi

mkdir "$work/pages"
cd "$work/pages"
exec 3>&2
trap 'cat "$work/log" >&3' ERR
{
  "$bin/shape-body" quadruped --pose sit,stretch --triangles 3000 --output 'animal%d.obj'
  "$bin/shape-interpolate" animal0.obj animal1.obj --shapes 7 --output walk.path,walk.glb
  "$bin/shape-interpolate" animal0.obj animal1.obj --metric rigid --shapes 3 --output rigid.path
  printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nl 1 2 3 4\n' >graph0.obj
  printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 1 0\nl 1 2 3 4\n' >graph1.obj
  "$bin/shape-interpolate" graph0.obj graph1.obj --shapes 3 --output graph.path,graph.glb
  # A square that is folded, red on the left and blue on the right by its texture.
  for height in 0 1; do
    printf 'mtllib skin.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 %s 1\n' $height
    printf 'vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl skin\nf 3/3 2/2 1/1\nf 4/4 3/3 1/1\n'
  done | split --lines=12 --numeric-suffixes --suffix-length=1 --additional-suffix=.obj - skin
  printf 'newmtl skin\nmap_Kd skin.png\n' >skin.mtl
  base64 -d >skin.png <<'EOF'
iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAADUlEQVR4nGP4zwAE/wEHAAH/4iOeWQAAAABJRU5ErkJggg==
EOF
  "$bin/shape-interpolate" skin0.obj skin1.obj --shapes 3 --output skin.glb,skin.path
  # The same, each triangle all of one colour.
  for height in 0 1; do
    printf 'mtllib skin.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 %s 1\n' $height
    printf 'vt .2 .5\nvt .8 .5\nusemtl skin\nf 3/1 2/1 1/1\nf 4/2 3/2 1/2\n'
  done | split --lines=10 --numeric-suffixes --suffix-length=1 --additional-suffix=.obj - seam
  "$bin/shape-interpolate" seam0.obj seam1.obj --shapes 3 --output seam.path
  head --bytes=40 skin.png >half.png
  sed s/skin.png/half.png/ skin.mtl >half.mtl
  sed s/skin.mtl/half.mtl/ seam0.obj >half0.obj
  "$bin/shape-interpolate" half0.obj seam1.obj --shapes 3 --output damaged-skin.html
  # A triangle that in one pose passes through another, and in the other pose is above it.
  for height in 0 3; do
    printf 'v 0 0 0\nv 4 0 0\nv 0 0 4\nv 1 %s 1\nv 2 %s 1\nv 1 %s 2\nf 1 3 2\nf 4 5 6\n' \
      $((height - 1)) $((height + 1)) $((height + 1))
  done | split --lines=8 --numeric-suffixes --suffix-length=1 --additional-suffix=.obj - pierced
  "$bin/shape-interpolate" pierced0.obj pierced1.obj --shapes 3 --output pierced.path
  "$bin/shape-export" walk.path --bones 8 --output bones.glb
  for file in walk.path walk.glb bones.glb pierced.path graph.path graph.glb skin.glb skin.path \
    seam.path; do
    "$bin/shape-view" $file --output "${file/./-}.html"
  done
  "$bin/shape-view" walk.path rigid.path --output two.html
  "$bin/shape-extrapolate" walk.path --steps 3 --output beyond.html
  "$bin/shape-body" quadruped --pose stand,sit,stretch --triangles 1000 --output 'step%d.obj'
  "$bin/shape-interpolate" step?.obj --shapes 7 --output chain.path
  "$bin/shape-interpolate" step?.obj --shapes 7 --spline natural --output spline.path
  "$bin/shape-view" chain.path spline.path --output smooth.html
  "$bin/shape-body" quadruped --pose stand,sit,stretch,rear --triangles 1000 --output 'pose%d.obj'
  "$bin/shape-explore" pose?.obj --depth 1 --output poses.space
  "$bin/shape-view" poses.space --output poses.html
  "$bin/shape-body" quadruped --pose stand,sit,stretch,rear,stride --triangles 1000 --output 'herd%d.obj'
  printf 'file,age\nherd0.obj,1\nherd1.obj,2\nherd2.obj,3\nherd3.obj,4\nherd4.obj,6\n' >ages.csv
  "$bin/shape-statistics" herd?.obj --modes 3 --output herd.modes
  "$bin/shape-statistics" herd.modes --scalars ages.csv --output herd.html
  "$bin/shape-statistics" herd.modes --output plain.html
  "$bin/shape-body" quadruped --pose stand --triangles 3000 --output 'small cat/body%d.obj'
  "$bin/shape-body" quadruped --pose stand --triangles 5000 --output 'lion/body%d.obj'
  "$bin/shape-view" 'small cat/body0.obj' lion/body0.obj --output markers.html
  "$bin/shape-view" animal0.obj --output mesh.html
  "$bin/shape-body" quadruped --pose stride --proportions heavy --triangles 4000 --output 'other%d.obj'
  "$bin/shape-correspond" 'small cat/body0.obj' other0.obj --output fit.html --markers_out found.txt
  SHAPESPACE_PAGE_DIR=$PWD SHAPESPACE_PAGE_TEMPLATE=$root/tools/viewer/dist/viewer.html \
    "$root/build/release/tests/output/output_test" --gtest_filter='*WritesSpaces*:*WritesForOther*'
  cp "$root/tools/viewer/dist/viewer.html" empty.html
  if [ -f "$root/tools/viewer/dist/solver.html" ]; then cp "$root/tools/viewer/dist/solver.html" .; fi
} >"$work/log" 2>&1
trap - ERR
cd "$work"
SHAPESPACE_PAGE_DIR=$work/pages SHAPESPACE_PAGE_BIN=$bin node --test page.test.mjs explained.test.mjs skinned.test.mjs \
  solver.test.mjs
