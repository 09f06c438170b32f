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
/usr/bin/python3 - "$work" "$out/shapespace-addon-$version.zip" <<'PYTHON'
import os, pathlib, sys, time, zipfile

folder, archive = pathlib.Path(sys.argv[1]), sys.argv[2]
date = time.gmtime(int(os.environ["SOURCE_DATE_EPOCH"]))[:6]
with zipfile.ZipFile(archive, "w") as out:
    for file in sorted(path for path in folder.rglob("*") if path.is_file()):
        entry = zipfile.ZipInfo(file.relative_to(folder).as_posix(), date)
        entry.compress_type = zipfile.ZIP_DEFLATED
        entry.external_attr = 0o100644 << 16
        out.writestr(entry, file.read_bytes())
PYTHON
