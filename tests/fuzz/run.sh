#!/bin/bash
# Runs the targets of tests/fuzz under libFuzzer and prints how many inputs each had and what was found:
#   tests/fuzz/run.sh PROGRAM [SECONDS [TARGET...]]
# Each target has so many seconds, 600 by default; as many as there are cores run at a time. Inputs that
# reach new code are kept in build/fuzz/corpus for the next run, what was found is in
# build/fuzz/findings. A finding that was mended goes into tests/fuzz/corpus/TARGET.
set -euo pipefail
program=$(realpath "$1")
export program seconds=${2:-600}
shift $(($# > 2 ? 2 : $#))
cd "$(dirname "$0")/../.."
if (($# == 0)); then
  set -- $(find tests/fuzz/corpus -mindepth 1 -maxdepth 1 -type d -printf '%f\n' | sort)
fi
rm -rf build/fuzz/findings
mkdir -p build/fuzz/findings build/fuzz/logs

one_target() {
  local log=build/fuzz/logs/$1 found=0
  mkdir -p "build/fuzz/corpus/$1"
  TARGET=$1 "$program" "build/fuzz/corpus/$1" "tests/fuzz/corpus/$1" -max_total_time="$seconds" \
    -max_len=16384 -timeout=120 -rss_limit_mb=4000 -print_final_stats=1 -verbosity=1 \
    -artifact_prefix="build/fuzz/findings/$1-" >"$log" 2>&1 || found=1
  local inputs
  inputs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  if ((found)); then
    echo "$1: ${inputs:-some} inputs, FOUND: $(grep -m1 -E 'ERROR|finding:|runtime error' "$log")"
    return 1
  fi
  echo "$1: $inputs inputs, nothing found"
}
export -f one_target
printf '%s\n' "$@" | xargs -P "$(nproc)" -I{} bash -c 'one_target {}'
