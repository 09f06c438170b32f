#!/bin/bash
# All that a release consists of, into build/release-X.Y.Z, which is made anew:
#   packaging/release.sh
# X.Y.Z is the version in CMakeLists.txt. Needs a working tree without changes, root for the bare systems
# in which packages are built, debootstrap, npm and network; takes about two hours on two cores. The
# same commit gives the same bytes (tests/packages/reproducible.sh). docs/RELEASING.md says what to do before
# and after.
set -euo pipefail
. "$(dirname "$0")/release_common.sh"
cd "$project"

changes=$(git status --porcelain)
[[ -z $changes ]] || die "the working tree has changes; commit them, or take them away:
$changes"
tests/docs/versions.sh . || die "the versions above have to be the one of CMakeLists.txt"
grep -qF "## [$version]" CHANGELOG.md || die "CHANGELOG.md has no section [$version]"

out=build/release-$version
rm -rf "$out" build/standalone/*/root/built  # so that wheels and tools are compiled anew
mkdir -p "$out"
step() {
  echo "== $* ($((SECONDS / 60)) min)"
}

step "source"
packaging/source.sh "$out"

step "add-on"
packaging/addon.sh "$out"

step "for browsers: npm package and pages"
./dev wasm
packaging/npm.sh "$out"
cp tools/viewer/dist/solver.html "$out/shapespace-$version.html"

step "tools for Windows"
./dev windows
packaging/windows.sh "$out"

step "wheels, source distribution"
packaging/wheel.sh bookworm "$out"
packaging/wheel.sh trixie "$out"

step "tools"
packaging/tools.sh "$out"

for release in bookworm trixie; do
  step "packages of Debian $release"
  packaging/debian.sh "$release" "$out/$release"
done

step "shared libraries for comparisons"
packaging/abi.sh "$out"

step "site"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
packaging/site.sh "$work/shapespace-$version-site"
pack "$out/shapespace-$version-site.tar.xz" "$work" "shapespace-$version-site"

step "bill of materials, notices"
packaging/sbom.py "$out"
tests/packages/materials.py "$out/shapespace-$version.spdx.json"

# Not of .buildinfo and .changes, which have the time of the build.
step "checksums"
(cd "$out" && find . -type f ! -name SHA256SUMS ! -name '*.buildinfo' ! -name '*.changes' -printf '%P\0' | sort -z | xargs -0 sha256sum >SHA256SUMS)
echo "release.sh: $(wc -l <"$out/SHA256SUMS") files in $out ($((SECONDS / 60)) min)"
