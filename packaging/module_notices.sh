#!/bin/bash
# The licences of what ./dev wasm compiles into javascript/shapespace-module.wasm, to standard output.
set -euo pipefail
cd "$(dirname "$0")/.."
cat NOTICES
for licence in build/wasm-libraries/licenses/* /usr/share/doc/libfast-float-dev/copyright \
  /usr/share/emscripten/system/lib/libc/musl/COPYRIGHT; do
  [[ $licence != */googletest ]] || continue # only tests have it
  printf '\n\n%s\n\n' "== $(basename "$(dirname "$licence")")/$(basename "$licence")"
  cat "$licence"
done
