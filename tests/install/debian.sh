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

[[ ${1:-} == bookworm || ${1:-} == trixie ]] || fail "say which release: bookworm or trixie"
release=$1
[[ $(id -u) == 0 ]] || fail "needs root"
command -v debootstrap >/dev/null || fail "needs debootstrap: apt-get install debootstrap"
mirror=$(apt-get indextargets --format '$(ORIGIN) $(SITE)' | awk '$1 == "Debian" { print $2; exit }')
[[ -n $mirror ]] || fail "apt knows no Debian mirror: apt-get update"

source=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
trap 'exit 1' HUP INT TERM
root=$work/system

debootstrap --variant=minbase "$release" "$root" "$mirror" >"$work/debootstrap.log" ||
  fail "debootstrap: $(tail -1 "$work/debootstrap.log")"
git clone -q "$source" "$root/root/shapespace"

# In the new system, with processes, mounts and terminals of its own that end with the command, and
# with nothing of this one's environment.
inside() {
  unshare --mount --pid --fork --kill-child --mount-proc="$root/proc" /bin/sh -c '
    mount -t devpts -o newinstance,ptmxmode=0666 devpts "$0/dev/pts" &&
    exec chroot "$0" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin \
      /bin/sh -c "cd /root/shapespace && $1"' "$root" "$1"
}

inside './dev demo'
[[ $(head -c 8 "$root/root/shapespace/build/demo/path.png" | od -An -tx1 | tr -d ' \n') == \
  89504e470d0a1a0a ]] || fail "$release: ./dev demo made no picture"
inside './dev test' 2>&1 | tee "$work/test.log"

echo "debian.sh: Debian $(cat "$root/etc/debian_version") ($release)," \
  "$(inside 'echo g++ $(g++ -dumpfullversion), CMake $(cmake --version | sed "s/.* //;q")'):" \
  "./dev demo and ./dev test passed:" \
  "$(grep 'tests passed' "$work/test.log")"
