#!/bin/bash
# Whether programs that were linked to one version of the shared libraries work with another:
#   tests/install/abi.sh OLD NEW
# OLD and NEW are folders into which shapespace was installed with -DBUILD_SHARED_LIBS=ON and compiled
# with -g. Fails if a function or a type of the public headers was removed or changed in a way that
# such programs notice, unless the library's SONAME has changed too. What was added is not reported.
set -euo pipefail

fail() {
  echo "abi.sh: $*" >&2
  exit 1
}

(($# == 2)) || fail "say which folders: OLD NEW"
command -v abidiff >/dev/null || fail "abidiff is missing. As root: apt-get install abigail-tools"
old=$1
new=$2

soname() { readelf -d "$1" | sed -nE 's/.*\(SONAME\).*\[(.*)\]/\1/p'; }

mapfile -t libraries < <(find "$old" -name 'libshapespace_*.so' | sort)
((${#libraries[@]})) || fail "$old has no shared libraries of shapespace"
changed=()
for library in "${libraries[@]}"; do
  name=$(basename "$library")
  other=$(find "$new" -name "$name")
  [[ -n $other ]] || fail "$new has no $name"
  for file in "$library" "$other"; do
    readelf -S "$file" | grep '\.debug_info' >/dev/null || fail "$file was compiled without -g"
  done
  if [[ $(soname "$library") != "$(soname "$other")" ]]; then
    echo "abi.sh: $name: $(soname "$library") became $(soname "$other"), so it may differ"
    continue
  fi
  # Exit code: bits 1 and 2 mean that abidiff failed, 4 that something changed, 8 that this certainly
  # breaks programs. A larger struct, which does so too, has only the bit 4.
  status=0
  abidiff --no-added-syms --exported-interfaces-only --drop-private-types \
    --headers-dir1 "$old/include" --headers-dir2 "$new/include" "$library" "$other" || status=$?
  ((!(status & 3))) || fail "abidiff cannot compare $library and $other"
  ((status == 0)) || changed+=("$name")
done
((${#changed[@]} == 0)) ||
  fail "${changed[*]}: changed as said above; undo it, or raise abi in CMakeLists.txt"
echo "abi.sh: ${#libraries[@]} libraries compared"
