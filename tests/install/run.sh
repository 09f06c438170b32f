#!/bin/bash
# Installs the release build into a folder of its own and builds a project against it, as a user of
# the library would, by CMake and by pkg-config; then takes the sources into a project with
# FetchContent. Needs a finished release build; takes its folder, build/release by default.
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

# What the documents show must be what compiles.
program_in() { sed -n '/^```cpp$/,/^```$/p' "$1" | sed '/^```/d'; }
for page in ceres deforming exploring features levels library; do
  program_in "$root/docs/guide/$page.md" >"$work/$page.cc"
done

cmake --install "$build" --prefix "$work/prefix" >"$work/install.log"
# Each header is compiled alone: those of the core without Ceres below, but for the one that defines
# features, the others here.
with_ceres=shapespace/metric/define_feature.h
cd "$work/prefix/include"
find shapespace -name '*.h' | sort >"$work/headers.txt"
find shapespace/{base,mesh,files,metric,path,hierarchy,analysis} -name '*.h' |
  grep -vx $with_ceres | sort >"$work/core_headers.txt"
core_headers=$(paste -sd ';' "$work/core_headers.txt")
headers=$(comm -23 "$work/headers.txt" "$work/core_headers.txt" | paste -sd ';')
[[ $headers == *shapespace/geodesic/geodesic.h* && $headers == *$with_ceres* ]] ||
  fail "headers are missing: $headers"

flags=(-march=native -fsanitize=address)
if grep -qw avx2 /proc/cpuinfo; then flags+=(-mavx2); fi
# That programs compile and what they print is the question, not how fast they are.
unoptimised=-DCMAKE_CXX_FLAGS_RELEASE=-O0
cmake -S "$here" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release "$unoptimised" \
  -DCMAKE_PREFIX_PATH="$work/prefix" -DHEADERS="$headers" \
  -DFLAGS="$(IFS=';' && echo "${flags[*]}")" -DGUIDE="$work" >"$work/configure.log" ||
  fail "the package is not found"
cmake --build "$work/build"

cd "$work"
"$work/build/consumer" | tee report.txt
grep -qx 'Termination  *converged' report.txt || fail "the solver did not converge"
[[ $(head -c 8 tube.png | od -An -tx1 | tr -d ' \n') == 89504e470d0a1a0a ]] ||
  fail "tube.png is no PNG"
for flag in "${flags[@]}"; do
  "$work/build/consumer${flag//[^a-z0-9]/_}" >report.txt ||
    fail "built with $flag tests/install/main.cc ends with exit code $?"
  grep -qx 'Termination  *converged' report.txt || fail "with $flag the solver did not converge"
done
"$work/build/openmesh_consumer" || fail "the adaptor for OpenMesh ends with exit code $?"
"$work/prefix/bin/shape-interpolate" --version
grep -q 'shapes inserted between' "$work/prefix/share/man/man1/shape-interpolate.1" ||
  fail "there is no manual page"
[[ -s $work/prefix/share/bash-completion/completions/shape-view ]] || fail "nothing completes flags"
"$work/prefix/bin/shape-body" tube --triangles 500 --at 0,90 --output 'pose%d.obj'
"$work/build/guide_library" pose0.obj pose1.obj | grep -qx 'Termination  *converged' ||
  fail "the guide's program did not converge"
"$work/build/guide_features" pose0.obj pose1.obj >report.txt || fail "a feature of one's own fails"
grep -q 'log area' report.txt || fail "a feature of one's own has no part in the energy"
"$work/prefix/bin/shape-body" tube --triangles 300 --at 0,90 --output 'pose%d.obj'
"$work/build/guide_ceres" pose0.obj pose1.obj | grep -q 'Termination: CONVERGENCE' ||
  fail "the guide's problem of Ceres did not converge"
"$work/prefix/bin/shape-body" quadruped --triangles 4000 --pose sit,stretch --output 'animal%d.obj'
"$work/build/guide_levels" animal0.obj animal1.obj | tee report.txt
awk '/^share/ { share = $NF } END { exit !(share > .99 && share < 1.01) }' report.txt ||
  fail "the guide's loop over levels does not end at Interpolate's energy"
[[ $(head -c 4 walk.glb) == glTF ]] || fail "walk.glb is no glTF"

# The core without Ceres.
cmake -S "$here/core" -B "$work/core" -G Ninja -DCMAKE_BUILD_TYPE=Release "$unoptimised" \
  -DHEADERS="$core_headers" \
  -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_DISABLE_FIND_PACKAGE_Ceres=ON >"$work/configure.log" ||
  fail "the component core is not found where Ceres is not"
cmake --build "$work/core"
"$work/core/core_consumer" pose0.obj pose1.obj
# Ceres' headers may be where every compiler finds them, so what was included is read from the build.
if ninja -C "$work/core" -t deps | grep /ceres/; then
  fail "a header of the component core includes the headers of Ceres above"
fi
cmake -S "$here/features" -B "$work/features" -G Ninja -DCMAKE_BUILD_TYPE=Release "$unoptimised" \
  -DCMAKE_PREFIX_PATH="$work/prefix" >"$work/configure.log" ||
  fail "the component features is not found"
cmake --build "$work/features"
"$work/features/features_consumer" pose0.obj pose1.obj
if ldd "$work/features/features_consumer" | grep -i ceres; then
  fail "a program that only defines features links Ceres"
fi

# Units as those of the release build: ccache has them then.
units=()
for option in CMAKE_UNITY_BUILD CMAKE_UNITY_BUILD_BATCH_SIZE; do
  units+=("-D$(grep "^$option:" "$build/CMakeCache.txt")")
done

# Shared libraries export what is public, and of the rest only what they, the tools, the Python module
# and a program that defines a feature call. Tools and program work with them.
shared=$root/build/shared
cmake -S "$root" -B "$shared" -G Ninja -DCMAKE_BUILD_TYPE=Release "${units[@]}" \
  "-D$(grep '^SHAPESPACE_WERROR:' "$build/CMakeCache.txt")" \
  -DBUILD_SHARED_LIBS=ON -DSHAPESPACE_BUILD_PYTHON=ON -DSHAPESPACE_BUILD_TESTS=OFF \
  -DPython_EXECUTABLE=/usr/bin/python3 -DPYTHON_EXECUTABLE=/usr/bin/python3 >"$work/configure.log" ||
  fail "shared libraries cannot be configured"
cmake --build "$shared" && cmake --install "$shared" --prefix "$work/shared" >"$work/install.log"
mapfile -t libraries < <(find "$work/shared" -name 'libshapespace_*.so')
((${#libraries[@]} == 4)) || fail "these are not the four shared libraries: ${libraries[*]}"
cmake -S "$here/features" -B "$work/features_shared" -G Ninja -DCMAKE_BUILD_TYPE=Release "$unoptimised" \
  -DCMAKE_PREFIX_PATH="$work/shared" >"$work/configure.log" ||
  fail "the package of shared libraries is not found"
cmake --build "$work/features_shared"
"$work/features_shared/features_consumer" pose0.obj pose1.obj
nm -DC --defined-only "${libraries[@]}" | sed -nE 's/^[0-9a-f]{16} . //p' | sort -u >exported.txt
grep -q '^shapespace::Interpolate(' exported.txt || fail "Interpolate is not exported"
nm -DC --undefined-only "${libraries[@]}" "$work"/shared/bin/* "$shared"/python/shapespace/_core*.so \
  "$work/features_shared/features_consumer" | sed -nE 's/^ +U //p' | sort -u >called.txt
if grep -vE '^((typeinfo|typeinfo name|vtable) for )?shapespace::(cost::|k?[A-Z])' exported.txt |
  comm -23 - called.txt | grep .; then
  fail "the shared libraries export the names above, which are not public and not needed"
fi
"$work/shared/bin/shape-interpolate" --shapes 3 --output shared.path pose0.obj pose1.obj
"$work/prefix/bin/shape-interpolate" --shapes 3 --output static.path pose0.obj pose1.obj
cmp shared.path static.path || fail "shared and static libraries do not give the same path"
if "$work/shared/bin/shape-interpolate" --output none.path pose0.obj missing.obj 2>error.txt; then
  fail "with shared libraries a missing file is no error"
fi
grep -q missing.obj error.txt || fail "with shared libraries this is said: $(cat error.txt)"

export PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name shapespace.pc)")
c++ -std=c++17 -O1 "$here/main.cc" $(pkg-config --cflags --libs shapespace) -o "$work/by_pkg_config" ||
  fail "what pkg-config says of shapespace does not build tests/install/main.cc"
"$work/by_pkg_config" | grep -qx 'Termination  *converged' ||
  fail "built by pkg-config tests/install/main.cc does not converge"

cmake -S "$here/subproject" -B "$work/parent" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  "$unoptimised" "${units[@]}" \
  -DFETCHCONTENT_FULLY_DISCONNECTED=ON -DSHAPESPACE_SOURCE="$root" \
  >"$work/configure.log" ||
  fail "another project cannot take shapespace in by FetchContent"
cmake --build "$work/parent" --target core_in_parent
"$work/parent/core_in_parent" pose0.obj pose1.obj
if grep -rlF -e "$root" "$work/prefix/include" "$work/prefix/lib" --include='*.cmake' \
  --include='*.h'; then
  fail "the files above name the folder that they were built in"
fi
echo "install test: passed"
