# What the parts of a release have in common; read by them (`. packaging/release_common.sh`).

project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
version=$(sed -nE 's/^project\(ShapeSpace VERSION ([0-9.]+).*/\1/p' "$project/CMakeLists.txt")

# Files carry the time of the last commit, so that the same commit gives the same bytes.
SOURCE_DATE_EPOCH=$(git -C "$project" log -1 --format=%ct)
export SOURCE_DATE_EPOCH

die() {
  echo "$(basename "$0"): $*" >&2
  exit 1
}

# out_folder FOLDER: makes it, and prints its full name.
out_folder() {
  [[ -n ${1:-} ]] || die "say into which folder"
  mkdir -p "$1" && (cd "$1" && pwd)
}

# pack_zip ARCHIVE.zip FOLDER: all files in it, likewise.
pack_zip() {
  /usr/bin/python3 - "$1" "$2" <<'PYTHON'
import os, pathlib, sys, time, zipfile

archive, folder = sys.argv[1], pathlib.Path(sys.argv[2])
date = time.gmtime(int(os.environ["SOURCE_DATE_EPOCH"]))[:6]
with zipfile.ZipFile(archive, "w") as out:
    for file in sorted(path for path in folder.rglob("*") if path.is_file()):
        entry = zipfile.ZipInfo(file.relative_to(folder).as_posix(), date)
        entry.compress_type = zipfile.ZIP_DEFLATED
        entry.external_attr = 0o100644 << 16
        out.writestr(entry, file.read_bytes())
PYTHON
}

# pack ARCHIVE.tar.xz FOLDER NAME: what is in FOLDER/NAME, with nothing of this machine or user.
pack() {
  tar --create --directory "$2" --sort=name --format=ustar --mtime="@$SOURCE_DATE_EPOCH" \
    --owner=0 --group=0 --numeric-owner --mode=u+rwX,go=rX "$3" | xz -9 --threads=1 >"$1"
}
