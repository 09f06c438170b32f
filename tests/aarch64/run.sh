#!/bin/bash
# Cross-compiles the kernels and what they are compared with for 64-bit ARM, and runs their tests in an
# emulator:
#   tests/aarch64/run.sh
# Chosen are the tests of what may differ between processors: energies and features (kernels written by
# hand against automatic differentiation), sparse factors and sums over arrays, and readers and writers
# of files (a char has no sign there). Tests hold what they compare equal to rounding, for an ARM
# processor rounds a product and a sum once where an x86-64 processor rounds twice. Needs Debian; what is
# missing of packaging/packages/aarch64.txt is installed.
set -euo pipefail
cd "$(dirname "$0")/../.."

fail() {
  echo "aarch64 test: $*" >&2
  exit 1
}

./dev packages <(sed '/:arm64/d' packaging/packages/aarch64.txt)

build=$PWD/build/aarch64
tests/aarch64/sysroot.sh "$build/sysroot"
mkdir -p "$build/kernels"
cmake -S tests/aarch64 -B "$build/kernels" -G Ninja --toolchain "$PWD/cmake/aarch64.cmake" \
  -DCMAKE_SYSROOT="$build/sysroot" -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON \
  >"$build/configure.log" || fail "not configured, see $build/configure.log"

programs=(metric_test numerics_test path_test mesh_test)
cmake --build "$build/kernels" --target "${programs[@]}"
ctest --test-dir "$build/kernels" --output-on-failure --no-tests=error \
  --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" \
  --label-regex "^($(IFS='|' && echo "${programs[*]}"))\$"
