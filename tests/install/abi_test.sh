#!/bin/bash
# Whether abi.sh notices what breaks programs, and nothing else: with a small library in several
# versions. Installs what is missing of packaging/packages/home.txt; takes some seconds.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
"$here/../../dev" packages packaging/packages/home.txt
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "abi_test.sh: $*" >&2
  exit 1
}

# library FOLDER SONAME FIELDS FUNCTIONS PRIVATE: a library that has a struct with these fields in its
# public header, these functions, and a private struct with these fields.
library() {
  mkdir -p "$work/$1/include" "$work/$1/lib"
  cat >"$work/$1/include/public.h" <<CPP
struct Hidden;
struct Options { $3 };
double Solve(const Options& options, const Hidden* hidden);
CPP
  cat >"$work/$1/library.cc" <<CPP
#include "public.h"
struct Hidden { $5 };
double Solve(const Options& options, const Hidden* hidden) { return options.size + hidden->a; }
$4
CPP
  g++ -g -shared -fPIC -Wl,-soname,"$2" -I "$work/$1/include" "$work/$1/library.cc" \
    -o "$work/$1/lib/libshapespace_small.so"
}

passes() {
  "$here/abi.sh" "$work/$1" "$work/$2" >"$work/log" 2>&1 ||
    fail "$2 should pass after $1, but: $(cat "$work/log")"
}

fails() {
  if "$here/abi.sh" "$work/$1" "$work/$2" >"$work/log" 2>&1; then
    fail "$2 should not pass after $1"
  fi
  grep -q 'libshapespace_small.so: changed' "$work/log" ||
    fail "$2 after $1 is not refused for its changes, but: $(cat "$work/log")"
}

library first small.so.0.1 'double size;' 'int Count() { return 1; }' 'double a;'
library same small.so.0.1 'double size;' 'int Count() { return 2; }' 'double a;'
library more small.so.0.1 'double size;' 'int Count() { return 1; } int Sum() { return 0; }' 'double a;'
library private small.so.0.1 'double size;' 'int Count() { return 1; }' 'double a, b;'
library fewer small.so.0.1 'double size;' '' 'double a;'
library longer small.so.0.1 'double size, weight;' 'int Count() { return 1; }' 'double a;'
library typed small.so.0.1 'double size;' 'long Count() { return 1; }' 'double a;'
library next small.so.0.2 'double size, weight;' '' 'double a;'

passes first same
passes first more
passes first private
fails first fewer
fails first longer
fails first typed
passes first next
echo "abi_test.sh: passed"
