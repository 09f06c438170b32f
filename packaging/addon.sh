#!/bin/bash
# The Blender add-on, shapespace-addon-X.Y.Z.zip:
#   packaging/addon.sh FOLDER
set -euo pipefail
. "$(dirname "$0")/release_common.sh"
out=$(out_folder "${1:-}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

addon=shapespace_addon
git -C "$project" archive --format=tar HEAD:blender "$addon" | tar --extract --directory "$work"
cp "$project/LICENSE" "$work/$addon/LICENSE"
pack_zip "$out/shapespace-addon-$version.zip" "$work"
