#!/bin/bash
# Every name of C++ that these pages have in backticks must be one in the headers of the library: a
# word in capitals and small letters, such as `Interpolate`, `Metric::unit` or `GeodesicStart::kBest`.
set -euo pipefail
export LC_ALL=C

root=${1:?names.sh <root of the sources>}
cd "$root"
words=$(find lib solvers -name '*.h' -exec cat {} + | grep -oE '[A-Za-z_][A-Za-z0-9_]*' | sort -u)
pages=(docs/mathematics.md docs/guide/{ceres,features,library}.md)
missing=0
for page in "${pages[@]}"; do
  # Code between fences is compiled by tests/install. ShapeSpace is the package in CMake.
  names=$(sed '/^```/,/^```$/d' "$page" | grep -oE '`[^`]+`' | tr -d '`' |
    grep -E '^k?[A-Z][a-z][A-Za-z0-9]*(::[A-Za-z0-9_]+|\.[a-z_]+)*(\(.*)?$' |
    grep -v '^ShapeSpace' | sed 's/(.*//; s/::/\n/g; s/\./\n/g' | sort -u)
  for name in $names; do
    grep -qxF -- "$name" <<<"$words" && continue
    echo "$page: no header in lib/ or solvers/ has the name $name" >&2
    missing=1
  done
done
exit $missing
