# The build of which the wheel and the self-contained tools are taken; read by their scripts
# (`. packaging/standalone.sh`). Needs root, debootstrap and 3 GB of disk.

. "$(dirname "${BASH_SOURCE[0]}")/release_common.sh"
. "$project/packaging/root.sh"
systems=$(out_folder "$project/build/standalone")

# What is built needs nothing of these when it runs: they are tools, headers, and giflib and zlib, which
# are linked statically. What else is linked comes from static_libraries.sh.
build_packages=(cmake g++ make ninja-build ccache xz-utils help2man
  libeigen3-dev libgif-dev libstb-dev libtinygltf-dev libxxhash-dev nlohmann-json3-dev zlib1g-dev
  pybind11-dev python3-dev python3-numpy python3-pip)

with_ccache="export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache"

# standalone_system RELEASE: Debian of that release with what is needed to build, in
# build/standalone/RELEASE, where it is kept.
standalone_system() {
  local root=$systems/$1
  [[ ! -e $root/packages ]] || return 0
  rm -rf --one-file-system "$root"
  make_root "$1" "$root" || return 1
  inside "$root" "apt-get -q update && apt-get -q install -y --no-install-recommends \
    ${build_packages[*]}" >>"$root.log" 2>&1 ||
    { echo "standalone.sh: apt-get: $(tail -1 "$root.log")" >&2; return 1; }
  touch "$root/packages"
}

# standalone_build RELEASE: builds module and tools in /root/build of the system `root`, which it
# sets; does nothing if they are built from these sources. The libraries are built on Debian 12, with a
# glibc that is old enough for both, and take a quarter of an hour the first time. CMake would look in
# LAPACK for a function of complex numbers, which this one lacks.
standalone_build() {
  local new sdist=shapespace-$version.tar.gz
  root=$systems/$1
  standalone_system bookworm && standalone_system "$1" || return 1
  cp "$project/packaging/static_libraries.sh" "$systems/bookworm/opt/"
  inside "$systems/bookworm" "$with_ccache && bash /opt/static_libraries.sh /opt/static" ||
    return 1
  if [[ $1 != bookworm ]]; then
    rm -rf "$root/opt/static"
    mkdir "$root/opt/static"
    tar -C "$systems/bookworm/opt/static" --exclude=./src -c . | tar -C "$root/opt/static" -x
  fi
  new=$(mktemp -d)
  PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$project/python /usr/bin/python3 -c \
    'import sys, build_backend; build_backend.build_sdist(sys.argv[1])' "$new"
  if [[ -e $root/root/built ]] && cmp -s "$new/$sdist" "$root/root/$sdist"; then
    rm -r "$new"
    return
  fi
  rm -rf "$root"/root/{built,source,build,shapespace-*.tar.gz}
  mkdir "$root/root/source"
  mv "$new/$sdist" "$root/root/"
  rm -r "$new"
  tar -xm --strip-components=1 -C "$root/root/source" -f "$root/root/$sdist"
  inside "$root" "$with_ccache SOURCE_DATE_EPOCH=$SOURCE_DATE_EPOCH
    cmake -S source -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON \
      -DSHAPESPACE_SUITESPARSE=OFF -DSHAPESPACE_BUILD_PYTHON=ON -DSHAPESPACE_BUILD_TESTS=OFF \
      -DCMAKE_PREFIX_PATH=/opt/static -DPython_EXECUTABLE=/usr/bin/python3 \
      -DBLAS_blas_LIBRARY=/opt/static/lib/libopenblas.a \
      -DLAPACK_lapack_LIBRARY=/opt/static/lib/libopenblas.a -DLAPACK_lapack_WORKS=ON \
      -DGIF_LIBRARY=/usr/lib/x86_64-linux-gnu/libgif.a \
      -DZLIB_LIBRARY=/usr/lib/x86_64-linux-gnu/libz.a \
      -DCMAKE_CXX_FLAGS='-ffunction-sections -fdata-sections -ffile-prefix-map=/root/=' \
      -DCMAKE_MODULE_LINKER_FLAGS=-Wl,--gc-sections \
      -DCMAKE_EXE_LINKER_FLAGS='-Wl,--gc-sections -static-libstdc++ -static-libgcc' &&
    cmake --build build && touch built"
}
