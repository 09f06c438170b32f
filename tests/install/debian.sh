#!/bin/bash
# Runs both commands of the README on a bare Debian system, as a newcomer would:
#   tests/install/debian.sh bookworm|trixie
# Makes that system in a temporary folder, from the mirror that apt uses here, clones what is
# committed into it, and takes it away again. Needs root, debootstrap and 4 GB of disk; takes about
# a quarter of an hour on two cores. By hand: .ci/run does not call it.
set -euo pipefail

fail() {
  echo "debian.sh: $*" >&2
  exit 1
}

release=${1:-}
source=$(cd "$(dirname "$0")/../.." && pwd)
. "$source/packaging/root.sh"
bare_system "$release"
git clone -q "$source" "$root/root/shapespace"

inside "$root" './dev demo' /root/shapespace
[[ $(head -c 8 "$root/root/shapespace/build/demo/path.png" | od -An -tx1 | tr -d ' \n') == \
  89504e470d0a1a0a ]] || fail "$release: ./dev demo made no picture"
inside "$root" './dev test' /root/shapespace 2>&1 | tee "$work/test.log"

echo "debian.sh: Debian $(cat "$root/etc/debian_version") ($release)," \
  "$(inside "$root" 'echo g++ $(g++ -dumpfullversion), CMake $(cmake --version | sed "s/.* //;q")'):" \
  "./dev demo and ./dev test passed:" \
  "$(grep 'tests passed' "$work/test.log")"
