#!/bin/bash
# The npm package, shapespace-X.Y.Z.tgz, of the module that ./dev wasm has built:
#   packaging/npm.sh FOLDER
# Nothing is published. Two runs give the same bytes.
set -euo pipefail
. "$(dirname "$0")/release_common.sh"
out=$(out_folder "${1:-}")
[[ -e $project/javascript/shapespace-module.wasm ]] || die "./dev wasm has to build the module first"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

git -C "$project" archive --format=tar HEAD:javascript | tar --extract --directory "$work"
cp "$project"/javascript/{NOTICES,shapespace-module.{mjs,wasm}} "$project/LICENSE" "$work/"
(cd "$work" && npm pack --silent --pack-destination "$out")
ls -l "$out/shapespace-$version.tgz"
