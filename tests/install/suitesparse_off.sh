#!/bin/bash
# The option SHAPESPACE_SUITESPARSE=OFF: refuses a Ceres with SuiteSparse; with one that packaging/ceres.sh
# makes, tools are built that link nothing of SuiteSparse, and Ceres' solvers find the same there as in the
# tools of BUILD (build/release), which link Debian's Ceres:
#   tests/install/suitesparse_off.sh [BUILD]
# Takes six minutes on two cores, or one where ccache knows the objects. Needs network.
set -euo pipefail
cd "$(dirname "$0")/../.."
release=$(cd "${1:-build/release}" && pwd)/bin

fail() {
  echo "suitesparse_off.sh: $*" >&2
  exit 1
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
off=(-DSHAPESPACE_SUITESPARSE=OFF -DSHAPESPACE_BUILD_TESTS=OFF)
if cmake -S . -B "$work/refused" -G Ninja "${off[@]}" >"$work/log" 2>&1; then
  fail "a Ceres with SuiteSparse is accepted"
fi
grep -q 'packaging/ceres.sh PREFIX' "$work/log" || fail "no remedy: $(tail "$work/log")"

prefix=$PWD/build/ceres
packaging/ceres.sh "$prefix"
cmake -S . -B build/suitesparse-off -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON "${off[@]}" \
  -DCMAKE_PREFIX_PATH="$prefix" >"$work/log" 2>&1 || fail "not configured: $(tail "$work/log")"
tools=(shape-interpolate shape-extrapolate shape-transport)
cmake --build build/suitesparse-off --target "${tools[@]}"
for tool in "${tools[@]}"; do
  if ldd "build/suitesparse-off/bin/$tool" | grep -E 'cholmod|spqr|amd|suitesparse|cxsparse'; then
    fail "$tool links SuiteSparse"
  fi
done

# same WHAT OUTPUT TOOL ARGUMENT...: the vertices, of a body of the size 6, of all meshes that both write.
same() {
  local what=$1 output=$2 tool=$3 bin
  shift 3
  for bin in "$release" build/suitesparse-off/bin; do
    rm -f "$work"/out*
    "$bin/$tool" "$@" --output "$work/$output" >"$work/log" 2>&1 || fail "$what: $(tail -n 3 "$work/log")"
    cat "$work"/out*.obj | grep -E '^v ' >"$work/${bin//\//_}"
  done
  paste "$work/${release//\//_}" "$work/${bin//\//_}" | awk -v what="$what" '
    {
      for (i = 2; i <= 4; ++i) {
        difference = $i - $(i + 4)
        if (difference < 0) difference = -difference
        if (difference > most) most = difference
      }
    }
    END {
      printf "%s: %d vertices differ by at most %.1e\n", what, NR, most
      exit NR == 0 || most > 1e-4
    }' || fail "$what differs"
}

"$release/shape-body" bar --at 0,60,70 --output "$work/bar%d.obj" >/dev/null
for solver in lbfgs trust_region; do
  same "a geodesic by $solver" out%d.obj shape-interpolate "$work/bar0.obj" "$work/bar1.obj" --shapes 1 --solver "$solver" \
    --tolerance 1e-10
done
same "steps by Ceres" out%d.obj shape-extrapolate "$work/bar0.obj" "$work/bar1.obj" --shapes 3 --tolerance 1e-10 --steps 2 \
  --step_solver ceres
same "the paper's transport" out.obj shape-transport "$work/bar0.obj" "$work/bar1.obj" "$work/bar2.obj" --steps 4 \
  --connection constrained_projection
