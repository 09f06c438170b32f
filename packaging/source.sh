#!/bin/bash
# The sources of the last commit as an archive, shapespace-X.Y.Z.tar.xz:
#   packaging/source.sh FOLDER
set -euo pipefail
. "$(dirname "$0")/release_common.sh"
out=$(out_folder "${1:-}")
git -C "$project" archive --format=tar --prefix="shapespace-$version/" HEAD |
  xz -9 --threads=1 >"$out/shapespace-$version.tar.xz"
