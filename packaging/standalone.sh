# The build of which the wheel and the self-contained tools are taken; read by their scripts
# (`. packaging/standalone.sh`). Needs root, debootstrap and 3 GB of disk.

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/root.sh"
: "${SOURCE_DATE_EPOCH:=$(git -C "$here" log -1 --format=%ct)}"
export SOURCE_DATE_EPOCH

# What is built needs nothing of these when it runs: they are tools, headers, and a zlib that is linked
# statically. What else is linked comes from static_libraries.sh.
build_packages=(cmake g++ make ninja-build ccache xz-utils help2man
  libeigen3-dev libstb-dev libtinygltf-dev libxxhash-dev nlohmann-json3-dev zlib1g-dev
  pybind11-dev python3-dev python3-numpy python3-pip)

# standalone_system FOLDER RELEASE: Debian of that release with what is needed to build, in that folder.
# There it is kept, because its libraries take a quarter of an hour to build.
standalone_system() {
  local root=$1 release=$2
  if [[ ! -e $root/packages ]]; then
    rm -rf --one-file-system "$root"
    make_root "$release" "$root" || return 1
    sed -n "s/^deb \([^ ]*\) $release \(.*\)/deb-src \1 bookworm \2/p" "$root/etc/apt/sources.list" \
      >"$root/etc/apt/sources.list.d/sources.list"
    inside "$root" "apt-get -q update && apt-get -q install -y --no-install-recommends \
      ${build_packages[*]}" >"$root.log" 2>&1 ||
      { echo "standalone.sh: apt-get: $(tail -1 "$root.log")" >&2; return 1; }
    touch "$root/packages"
  fi
  cp "$here/static_libraries.sh" "$root/opt/"
  inside "$root" 'PATH=/usr/lib/ccache:$PATH bash /opt/static_libraries.sh /opt/static'
}

# standalone_build RELEASE: builds module and tools in /root/build of the system `root`, which it sets as
# well as `version`; does nothing if they are built from these sources.
standalone_build() {
  local new
  root=$here/../build/standalone/$1
  mkdir -p "$root"
  root=$(cd "$root" && pwd)
  standalone_system "$root" "$1" || return 1
  new=$(mktemp -d)
  PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$here/../python /usr/bin/python3 -c \
    'import sys, build_backend; build_backend.build_sdist(sys.argv[1])' "$new"
  sdist=$(basename "$new"/*.tar.gz)
  version=${sdist#shapespace-} version=${version%.tar.gz}
  if [[ -e $root/root/built ]] && cmp -s "$new/$sdist" "$root/root/$sdist"; then
    rm -r "$new"
    return
  fi
  rm -rf "$root"/root/{built,source,build,shapespace-*.tar.gz}
  mkdir "$root/root/source"
  mv "$new/$sdist" "$root/root/"
  rm -r "$new"
  tar -xm --strip-components=1 -C "$root/root/source" -f "$root/root/$sdist"
  inside "$root" "export PATH=/usr/lib/ccache:\$PATH SOURCE_DATE_EPOCH=$SOURCE_DATE_EPOCH
    cmake -S source -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON \
      -DSHAPESPACE_SUITESPARSE=OFF -DSHAPESPACE_BUILD_PYTHON=ON -DSHAPESPACE_BUILD_TESTS=OFF \
      -DCMAKE_PREFIX_PATH=/opt/static -DPython_EXECUTABLE=/usr/bin/python3 \
      -DBLAS_blas_LIBRARY=/opt/static/lib/libopenblas.a \
      -DLAPACK_lapack_LIBRARY=/opt/static/lib/libopenblas.a \
      -DZLIB_LIBRARY=/usr/lib/x86_64-linux-gnu/libz.a \
      -DCMAKE_CXX_FLAGS='-ffunction-sections -fdata-sections -ffile-prefix-map=/root/=' \
      -DCMAKE_MODULE_LINKER_FLAGS=-Wl,--gc-sections \
      -DCMAKE_EXE_LINKER_FLAGS='-Wl,--gc-sections -static-libstdc++ -static-libgcc' &&
    cmake --build build && touch built"
}
