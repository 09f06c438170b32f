#!/bin/bash
# Runs the targets of tests/fuzz under libFuzzer and prints how many inputs each had and what was found:
#   tests/fuzz/run.sh PROGRAM [SECONDS [TARGET...]]
# Each target has so many seconds, 600 by default; as many as there are cores run at a time. Inputs that
# reach new code are kept in build/fuzz/corpus for the next run, what was found is in
# build/fuzz/findings. A finding that was mended goes into tests/fuzz/corpus/TARGET.
#
# Findings are also: more than ten seconds for one input, and more than 256 MB at once, which no file of
# 32 kB accounts for. "Code" counts the edges that the corpus of the target reached at first, and with
# the inputs that were found: it shows that they get beyond the first check of a reader.
set -euo pipefail
program=$(realpath "$1")
# Most targets read a file: it is written where that costs least.
if [ -w /dev/shm ]; then export TMPDIR=/dev/shm; fi
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
    -max_len=32768 -timeout=10 -rss_limit_mb=2000 -malloc_limit_mb=256 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/findings/$1-" >"$log" 2>&1 || found=1
  local inputs rate code
  inputs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  rate=$(sed -n 's/^stat::average_exec_per_sec: *//p' "$log")
  code=$(sed -n 's/.*INITED *cov: \([0-9]*\) .*/\1/p' "$log")
  code=${code:-none}-$(sed -n 's/^#.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
  if ((found)); then
    echo "$1: ${inputs:-some} inputs, FOUND: $(grep -m1 -E 'ERROR|finding:|runtime error' "$log")"
    return 1
  fi
  echo "$1: $inputs inputs, $rate a second, code $code, nothing found"
}
export -f one_target
printf '%s\n' "$@" | xargs -P "$(nproc)" -I{} bash -c 'one_target {}'
