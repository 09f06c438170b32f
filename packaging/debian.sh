#!/bin/bash
# Builds the Debian packages for one release of Debian, in a bare system of that release:
#   packaging/debian.sh bookworm|trixie FOLDER
# Takes what is committed, and the page of shape-view from tools/viewer/dist. Puts the packages and
# their source into FOLDER. lintian must find no error or warning. The packages are the same, byte for
# byte, each time. Needs root, debootstrap and 5 GB of disk; takes ten minutes on two cores.
set -euo pipefail

fail() {
  echo "debian.sh: $*" >&2
  exit 1
}

[[ ${1:-} == bookworm || ${1:-} == trixie ]] || fail "say which release: bookworm or trixie"
[[ -n ${2:-} ]] || fail "say into which folder the packages go"
release=$1
mkdir -p "$2"
out=$(cd "$2" && pwd)
project=$(cd "$(dirname "$0")/.." && pwd)
. "$project/packaging/root.sh"
page=tools/viewer/dist/viewer.html
[[ -f $project/$page ]] || fail "$page is missing: ./dev viewer builds it"
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
trap 'exit 1' HUP INT TERM
root=$work/system

# The original tarball, the same for all releases: what is committed, without debian/, and the page.
cd "$project"
version=$(git show HEAD:debian/changelog | sed -nE '1s/^shapespace \(([0-9.]+)-.*/\1/p')
[[ -n $version ]] || fail "debian/changelog does not begin with a version"
source=$work/shapespace-$version
mkdir "$source"
git archive HEAD -- . ':!debian' | tar -x -C "$source"
install -D -m 644 "$page" "$source/$page"
tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner \
  --mtime="@$(git log -1 --format=%ct)" -c "shapespace-$version" |
  xz >"$work/shapespace_$version.orig.tar.xz"

# So that each release has a version of its own, and the later one the higher: 0.1.0-1~deb12.
make_root "$release" "$root"
git archive HEAD -- debian | tar -x -C "$source"
number=$(cut -d . -f 1 "$root/etc/debian_version")
sed -i "1s/) unstable;/~deb$number) $release;/" "$source/debian/changelog"
mkdir "$root/build"
mv "$source" "$work/shapespace_$version.orig.tar.xz" "$root/build"

in_source() { inside "$root" "$1" "/build/shapespace-$version"; }
in_source 'apt-get -q update && apt-get -q install -y --no-install-recommends build-essential lintian &&
  apt-get -q build-dep -y --no-install-recommends ./' >"$work/apt.log" 2>&1 ||
  fail "$release: $(tail -3 "$work/apt.log")"
# Without network, and without packages of symbols for debuggers, nor the symbols themselves.
in_source 'DEB_BUILD_OPTIONS="nocheck noautodbgsym" DEB_CXXFLAGS_STRIP=-g unshare --net \
  dpkg-buildpackage -us -uc' >"$work/build.log" 2>&1 ||
  fail "$release: the build failed: $(tail -30 "$work/build.log")"
inside "$root" 'lintian --allow-root --fail-on error,warning *.changes' /build ||
  fail "$release: lintian has found the above"

cp "$root"/build/*_"$version"[-.]* "$out"
echo "debian.sh: Debian $(cat "$root/etc/debian_version") ($release): packages are in $out"
