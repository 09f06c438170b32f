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
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
trap 'exit 1' HUP INT TERM
root=$work/system

make_root "$release" "$root"
install() { inside "$root" "apt-get -q install -y --no-install-recommends $*" >"$work/apt.log" 2>&1 ||
  fail "apt-get: $(tail -1 "$work/apt.log")"; }
inside "$root" 'apt-get -q update' >"$work/apt.log" 2>&1 || fail "apt-get: $(tail -1 "$work/apt.log")"
install python3 python3-venv python3-numpy
cp "$wheel" "$root/root/"
cp "$source/tests/packages/interpolate.py" "$root/root/"

# From pip to the result.
before=$(date +%s.%N)
inside "$root" 'python3 -m venv --system-site-packages venv &&
  venv/bin/pip install -q --no-index ./*.whl && venv/bin/python interpolate.py'
echo "wheel.sh: $release: $(echo "$(date +%s.%N) $before" | awk '{ printf "%.1f", $1 - $2 }') s" \
  "from pip install to the result"
inside "$root" 'rm -rf /root/venv/pip-cache; ldd venv/lib/python3*/site-packages/shapespace/_core*.so'

# Tests of files, pages and the guide want what the whole project has.
install python3-pytest
cp -r "$source/python/tests" "$root/root/tests"
inside "$root" 'venv/bin/python -m pytest -q -p no:cacheprovider tests/test_arrays.py \
  tests/test_solvers.py tests/test_spaces.py tests/test_pickling.py tests/test_options.py'

# In Blender, as docs/guide/blender.md says; Debian's has the system's Python.
install blender
before=$(date +%s.%N)
inside "$root" 'venv/bin/pip install -q --no-index --no-deps --target scripts/modules ./*.whl &&
  BLENDER_USER_SCRIPTS=/root/scripts blender --background --factory-startup --python-exit-code 1 \
    --python interpolate.py' >"$work/blender.log" 2>&1 || { cat "$work/blender.log" >&2; fail "in Blender it fails"; }
grep 'converged' "$work/blender.log" || fail "Blender ran nothing: $(cat "$work/blender.log")"
echo "wheel.sh: $release: $(echo "$(date +%s.%N) $before" | awk '{ printf "%.1f", $1 - $2 }') s" \
  "from pip install to the result in $(inside "$root" 'blender --version' | head -1)"
