#!/bin/bash
# Installs the release build into a folder of its own and builds a project against it, as a user of
# the library would. Needs a finished release build; takes its folder, build/release by default.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=${1:-$root/build/release}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "install test: $*" >&2
  exit 1
}

# The README shows this program; what it shows must be what compiles.
diff "$here/main.cc" <(sed -n '/^```cpp$/,/^```$/p' "$root/README.md" | sed '/^```/d') ||
  fail "the README's program is not tests/install/main.cc"

cmake --install "$build" --prefix "$work/prefix" >"$work/install.log"
headers=$(cd "$work/prefix/include" && find shapespace -name '*.h' | sort | paste -sd ';')
[[ $headers == *shapespace/solvers/geodesic.h* ]] || fail "headers are missing: $headers"

cmake -S "$here" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$work/prefix" -DHEADERS="$headers" >"$work/configure.log" ||
  fail "the package is not found"
cmake --build "$work/build"

cd "$work"
"$work/build/consumer" | tee report.txt
grep -qx 'Termination  *converged' report.txt || fail "the solver did not converge"
[[ $(head -c 8 tube.png | od -An -tx1 | tr -d ' \n') == 89504e470d0a1a0a ]] ||
  fail "tube.png is no PNG"
"$work/prefix/bin/shape-interpolate" --version
if grep -rlF -e "$root" "$work/prefix/include" "$work/prefix/lib" --include='*.cmake' \
  --include='*.h'; then
  fail "the files above name the folder that they were built in"
fi
echo "install test: passed"
