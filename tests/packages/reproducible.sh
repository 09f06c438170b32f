#!/bin/bash
# Whether two folders have the same files with the same bytes; names those that differ:
#   tests/packages/reproducible.sh FOLDER FOLDER
# but for .buildinfo and .changes of Debian packages, which have the time of the build.
# For two runs of one script of packaging/, or of ./dev release, as docs/RELEASING.md says.
set -euo pipefail

fail() {
  echo "reproducible.sh: $*" >&2
  exit 1
}

(($# == 2)) || fail "say which two folders"
names() { (cd "$1" && find . -type f ! -name '*.buildinfo' ! -name '*.changes' -printf '%P\n' | sort); }
first=$(names "$1")
second=$(names "$2")
[[ -n $first ]] || fail "$1 has no files"
diff <(echo "$first") <(echo "$second") || fail "the folders do not have the same files"
differing=()
while read -r name; do
  cmp -s "$1/$name" "$2/$name" || differing+=("$name")
done <<<"$first"
((${#differing[@]} == 0)) || fail "these differ (diffoscope says in what): ${differing[*]}"
echo "reproducible.sh: $(wc -l <<<"$first") files, all the same"
