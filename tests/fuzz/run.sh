#!/bin/bash
# Runs the targets of tests/fuzz under libFuzzer and prints how many inputs each had and what was found:
#   tests/fuzz/run.sh PROGRAM [SECONDS|INPUTSx [TARGET...]]
# Each target has so many seconds, 600 by default; as many as there are cores run at a time. Inputs that
# reach new code are kept in build/fuzz/corpus for the next run, what was found is in
# build/fuzz/findings. A finding that was mended goes into tests/fuzz/corpus/TARGET.
#
# With a number that ends in x, such as 20000x, each reader has so many inputs, and each solver a
# two-hundredth of them: the same ones whenever the program is the same, so that what passes once
# passes again.
#
# Findings are also: more than ten seconds for one input (a hundred if their number is given), and more
# than 256 MB at once, which no file of 32 kB accounts for. "Code" counts the edges that the corpus of the
# target reached at first, and with the inputs that were found: it shows that they get beyond the first
# check of a reader.
set -euo pipefail
program=$(realpath "$1")
# Most targets read a file: it is written where that costs least.
if [ -w /dev/shm ]; then export TMPDIR=/dev/shm; fi
export program limit=${2:-600}
shift $(($# > 2 ? 2 : $#))
cd "$(dirname "$0")/../.."
if (($# == 0)); then
  set -- $(find tests/fuzz/corpus -mindepth 1 -maxdepth 1 -type d -printf '%f\n' | sort)
fi
rm -rf build/fuzz/findings
mkdir -p build/fuzz/findings build/fuzz/logs

one_target() {
  local log=build/fuzz/logs/$1 kept=build/fuzz/corpus/$1 inputs=${limit%x} found=0
  local until=(-max_total_time="$limit" -timeout=10)
  if [[ $limit == *x ]]; then
    kept=build/fuzz/same/$1
    rm -rf "$kept"
    case $1 in
      average | correspond | deform | explore | extrapolate | interpolate | spline | transfer)
        inputs=$((inputs / 200)) ;;
    esac
    until=(-runs="$inputs" -seed=1 -timeout=100)
  fi
  mkdir -p "$kept"
  TARGET=$1 "$program" "$kept" "tests/fuzz/corpus/$1" "${until[@]}" \
    -max_len=32768 -rss_limit_mb=2000 -malloc_limit_mb=256 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/findings/$1-" >"$log" 2>&1 || found=1
  local rate code
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
