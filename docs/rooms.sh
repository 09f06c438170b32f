#!/bin/bash
# The rooms (folders of lib/shapespace and solvers/shapespace), and which includes headers of which.
#   docs/rooms.sh arrows    prints "from to" for each pair of rooms
#   docs/rooms.sh reduced   the same without the arrows that follow from others
#   docs/rooms.sh picture   draws the reduced arrows into docs/pictures/rooms.svg, with Graphviz
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."

arrows() {
  grep -roE --include='*.h' --include='*.cc' '^#include <shapespace/[a-z]+/' {lib,solvers}/shapespace |
    sed -E 's|^[a-z]+/shapespace/([a-z]+)/.*<shapespace/([a-z]+)/|\1 \2|' |
    awk '$1 != $2' | sort -u
}

# An arrow follows from others if a path of two or more arrows leads to the same room.
reduced() {
  arrows | awk '
    { arrow[$1, $2] = reach[$1, $2] = 1; room[$1] = room[$2] = 1 }
    END {
      for (k in room) for (i in room) for (j in room)
        if (reach[i, k] && reach[k, j]) reach[i, j] = 1
      for (i in room) for (j in room) {
        follows = 0
        for (k in room) if (reach[i, k] && reach[k, j]) follows = 1
        if (arrow[i, j] && !follows) print i, j
      }
    }' | sort
}

picture() {
  {
    echo 'digraph rooms {'
    echo 'rankdir = BT; node [shape = box, style = "rounded,filled", fontname = "sans-serif",'
    echo 'fontsize = 12, fillcolor = "#dceadf"]; edge [color = "#555555", arrowsize = 0.7];'
    for folder in lib/shapespace/*/; do
      echo "$(basename "$folder") [fillcolor = \"#dce6f2\"];"
    done
    reduced | awk '{ print $1 " -> " $2 ";" }'
    echo '}'
  } | dot -Tsvg >docs/pictures/rooms.svg
}

case ${1:-} in
  arrows | reduced | picture) "$1" ;;
  *) sed -n '2,5s/^# //p' "$0" >&2 && exit 2 ;;
esac
