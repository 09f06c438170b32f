#!/bin/bash
# Builds a wheel that stands alone, and the source distribution:
#   packaging/wheel.sh bookworm|trixie OUTPUT_FOLDER
# The wheel is for that Debian's Python (3.11, 3.13) and systems with its glibc (2.36, 2.41) or later;
# it needs numpy, and no other package. All libraries are linked statically with hidden symbols, so that
# they do not meet those of numpy, Blender or another module in one process. It contains nothing under
# the GPL. Two runs on the same sources give the same bytes.
set -euo pipefail
. "$(dirname "$0")/standalone.sh"

output=$(out_folder "${2:-}")
standalone_build "${1:-}"
inside "$root" "rm -rf wheel && export SOURCE_DATE_EPOCH=$SOURCE_DATE_EPOCH &&
  glibc=\$(getconf GNU_LIBC_VERSION | sed 's/glibc //; s/[.]/_/') &&
  python3 -m pip wheel ./source --no-index --no-deps --wheel-dir wheel \
    --config-settings build-dir=/root/build --config-settings licenses=/opt/static/licenses \
    --config-settings platform=manylinux_\${glibc}_x86_64"
wheel=$(echo "$root"/root/wheel/*.whl)
"$project/packaging/audit_wheel.py" "$wheel"
cp "$wheel" "$root/root/shapespace-$version.tar.gz" "$output"
(cd "$output" && ls -l "$(basename "$wheel")" "shapespace-$version.tar.gz")
