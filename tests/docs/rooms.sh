#!/bin/bash
# The table of rooms in docs/architecture.md, the picture beside it and what sources include agree.
set -euo pipefail
export LC_ALL=C

root=${1:?rooms.sh <root of the sources>}
cd "$root"
from_sources=$(docs/rooms.sh reduced)
# Rows such as: | `path/` | what it holds | metric, files |
from_table=$(sed -nE 's#^\| `([a-z]+)/` \|.*\| ([a-z, ]*) ?\|$#\1 \2#p' docs/architecture.md |
  awk '{ gsub(",", ""); for (i = 2; i <= NF; ++i) print $1, $i }' | sort)
from_picture=$(sed -nE 's#^<title>([a-z]+)&\#45;&gt;([a-z]+)</title>#\1 \2#p' docs/pictures/rooms.svg |
  sort)

compare() {
  diff <(echo "$from_sources") <(echo "$1") >&2 && return
  echo "$2 differs from what sources include (< sources, > $2): $3" >&2
  exit 1
}
compare "$from_table" "the table in docs/architecture.md" \
  "a new arrow needs a reason, and none may lead upward"
compare "$from_picture" "docs/pictures/rooms.svg" "run docs/rooms.sh picture"
