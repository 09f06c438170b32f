#!/bin/bash
# Builds the Debian packages for one release of Debian, in a bare system of that release:
#   packaging/debian.sh bookworm|trixie FOLDER
# Takes what is committed, and the page of shape-view from tools/viewer/dist. Puts the packages and
# their source into FOLDER. lintian must find no error or warning. The packages are the same, byte for
# byte, each time. Needs root, debootstrap and 5 GB of disk; takes ten minutes on two cores.
set -euo pipefail

. "$(dirname "$0")/release_common.sh"
. "$project/packaging/root.sh"
release=${1:-}
out=$(out_folder "${2:-}")
cd "$project"
page=tools/viewer/dist/viewer.html
[[ -f $page ]] || die "$page is missing: ./dev viewer builds it"
bare_system "$release"

# The original tarball, the same for all releases: what is committed, without debian/, and the page.
source=$work/shapespace-$version
mkdir "$source"
git archive HEAD -- . ':!debian' | tar -x -C "$source"
install -D -m 644 "$page" "$source/$page"
pack "$work/shapespace_$version.orig.tar.xz" "$work" "shapespace-$version"

# So that each release has a version of its own, and the later one the higher: 0.1.0-1~deb12.
git archive HEAD -- debian | tar -x -C "$source"
number=$(cut -d . -f 1 "$root/etc/debian_version")
sed -i "1s/) unstable;/~deb$number) $release;/" "$source/debian/changelog"
mkdir "$root/build"
mv "$source" "$work/shapespace_$version.orig.tar.xz" "$root/build"

in_source() { inside "$root" "$1" "/build/shapespace-$version"; }
in_source 'apt-get -q update && apt-get -q install -y --no-install-recommends build-essential lintian &&
  apt-get -q build-dep -y --no-install-recommends ./' >"$work/apt.log" 2>&1 ||
  die "$release: $(tail -3 "$work/apt.log")"
# Without network, and without packages of symbols for debuggers, nor the symbols themselves.
in_source 'DEB_BUILD_OPTIONS="nocheck noautodbgsym" DEB_CXXFLAGS_STRIP=-g unshare --net \
  dpkg-buildpackage -us -uc' >"$work/build.log" 2>&1 ||
  die "$release: the build failed: $(tail -30 "$work/build.log")"
inside "$root" 'lintian --allow-root --fail-on error,warning *.changes' /build ||
  die "$release: lintian has found the above"

cp "$root"/build/*_"$version"[-.]* "$out"
echo "debian.sh: Debian $(cat "$root/etc/debian_version") ($release): packages are in $out"
