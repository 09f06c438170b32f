#!/bin/bash
# Builds a Ceres without SuiteSparse, whose parts are under the GPL, from Debian's sources:
#   packaging/ceres.sh PREFIX
# for `cmake -DSHAPESPACE_SUITESPARSE=OFF -DCMAKE_PREFIX_PATH=PREFIX`. Needs what packaging/packages/build.txt
# lists, and network.
set -euo pipefail

exec "$(dirname "$0")/static_libraries.sh" "${1:?ceres.sh: say the folder to install into}" ceres-solver
