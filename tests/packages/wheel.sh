#!/bin/bash
# Tries a wheel that packaging/wheel.sh has built on a bare Debian system with Python and numpy alone:
#   tests/packages/wheel.sh bookworm|trixie WHEEL
# Installs it there, computes a path, checks it, and runs those tests of the module that need no other
# package than pytest; then does the first of these in Blender. Needs root, debootstrap, network and 3 GB
# of disk; takes the system away again.
set -euo pipefail

fail() {
  echo "wheel.sh: $*" >&2
  exit 1
}

release=${1:?wheel.sh: say which release: bookworm or trixie}
wheel=${2:?wheel.sh: say which wheel}
source=$(cd "$(dirname "$0")/../.." && pwd)
. "$source/packaging/root.sh"
bare_system "$release"
install() { inside "$root" "apt-get -q install -y --no-install-recommends $*" >"$work/apt.log" 2>&1 ||
  fail "apt-get: $(tail -1 "$work/apt.log")"; }
inside "$root" 'apt-get -q update' >"$work/apt.log" 2>&1 || fail "apt-get: $(tail -1 "$work/apt.log")"
install python3 python3-venv python3-numpy
cp "$wheel" "$root/root/"
cp "$source/tests/packages/interpolate.py" "$root/root/"

# timed WHAT COMMAND: runs it in the system and says how long it took.
timed() {
  local before
  before=$(date +%s.%N)
  inside "$root" "$2" 2>&1 | tee "$work/log" || fail "$1 fails"
  grep -q 'lengths half way' "$work/log" || fail "$1 computed nothing"
  echo "wheel.sh: $release: $(echo "$(date +%s.%N) $before" | awk '{ printf "%.1f", $1 - $2 }') s for $1"
}

inside "$root" 'python3 -m venv --system-site-packages venv'
timed "pip install and a path" 'venv/bin/pip install --no-index ./*.whl && venv/bin/python interpolate.py'

# What needs a package that is not there is skipped: the tools, mypy, scipy, meshio, nbclient.
install python3-pytest
git -C "$source" archive HEAD python docs README.md | tar -x -C "$root/root"
inside "$root" 'venv/bin/python -m pytest -q -p no:cacheprovider python/tests'

# In Blender, as docs/guide/blender.md says; Debian's has the system's Python. With --factory-startup it
# would not look into the user's folder.
install blender
timed "pip install and a path in $(inside "$root" 'blender --version' | head -1)" \
  'venv/bin/pip install --no-index --no-deps --target scripts/modules ./*.whl &&
  BLENDER_USER_SCRIPTS=/root/scripts blender --background --python-exit-code 1 \
    --python interpolate.py'
