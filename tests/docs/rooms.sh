#!/bin/bash
# The table of rooms in docs/architecture.md, the picture beside it and what sources include agree, and no
# room includes what is private to another one.
set -euo pipefail
export LC_ALL=C

root=${1:?rooms.sh <root of the sources>}
cd "$root"
# What is in the folder detail/ of a room is for that room, tests and benchmarks.
for room in {lib,solvers}/shapespace/*/; do
  if grep -rn "#include <shapespace/$(basename "$room")/detail/" lib solvers tools python |
    grep -v "^$room"; then
    echo "the lines above include what is private to the room $room: it belongs into internal/" >&2
    exit 1
  fi
done

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
