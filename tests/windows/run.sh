#!/bin/bash
# Runs the tests of the tools (tests/tools) on the programs for Windows that ./dev windows has built, in
# wine:
#   tests/windows/run.sh [GOOGLETEST_FILTER]
# The tests themselves are programs of this system. In expected_failures.txt are those that test what
# wine or Windows does not have, and why.
set -euo pipefail
cd "$(dirname "$0")/../.."
programs=$(pwd)/build/windows/bin
wrapped=$(pwd)/build/windows-in-wine
[[ -e $programs/shape-interpolate.exe ]] || { echo "run.sh: ./dev windows comes first" >&2; exit 1; }

# Each tool by its name, as the tests call it.
rm -rf "$wrapped/bin"
mkdir -p "$wrapped/bin"
for program in "$programs"/shape-*.exe; do
  printf '#!/bin/sh\nexec wine %s "$@"\n' "$program" >"$wrapped/bin/$(basename "$program" .exe)"
done
chmod +x "$wrapped"/bin/*

export WINEDEBUG=-all WINEPREFIX=${WINEPREFIX:-$wrapped/prefix}
wineserver -k || true
mkdir -p "$WINEPREFIX"
wineserver -p # programs start in a tenth of the time while it runs
wine cmd /c exit >/dev/null 2>&1 # makes what Windows has
trap 'wineserver -k; cmake --preset release -USHAPESPACE_TESTED_TOOLS >/dev/null' EXIT
cmake --preset release -DSHAPESPACE_TESTED_TOOLS="$wrapped/bin" >/dev/null
cmake --build --preset release --target tools_test
excluded=$(sed 's/ *#.*//; /^$/d' tests/windows/expected_failures.txt | paste -sd:)
build/release/tests/tools/tools_test --gtest_brief=1 --gtest_filter="${1:-*}:-$excluded"
