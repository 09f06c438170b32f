#!/bin/bash
# Builds the libraries that shapespace links, as static and position-independent ones:
#   packaging/static_libraries.sh PREFIX [LIBRARY...]
# installs them all, or those that are named, such as ceres-solver, and their licences into
# PREFIX/licenses. Debian's own packages do not serve for a wheel: most have no static library that a
# Python module can link, shared ones would meet Blender's Embree and TBB in one process, and Ceres links
# SuiteSparse, parts of which are under the GPL. Here it has Eigen's sparse solver alone. giflib and
# zlib are Debian's, unless they are named too. For another system than this one, CMAKE_TOOLCHAIN_FILE in
# the environment names what CMake needs (cmake/wasm.cmake). Needs g++, cmake, ninja-build, make,
# xz-utils, libeigen3-dev, libgif-dev and zlib1g-dev, and network. What is built already is not built
# again.
set -euo pipefail

prefix=$(mkdir -p "${1:?static_libraries.sh: say the folder to install into}" && cd "$1" && pwd)
shift
# In this order, because Embree finds TBB, and Ceres glog.
all=(expat gflags google-glog qhull openmesh onetbb embree openblas ceres-solver)
libraries=("${@:-${all[@]}}")
work=$prefix/src
mkdir -p "$work" "$prefix/licenses"
cp /usr/share/doc/zlib1g-dev/copyright "$prefix/licenses/zlib"
cp /usr/share/doc/libgif-dev/copyright "$prefix/licenses/giflib"
# For another system, whose compiler must not see the headers of this one, those that are no more than
# headers are copied.
if [[ ${CMAKE_TOOLCHAIN_FILE-} ]]; then
  mkdir -p "$prefix"/{include,share/cmake}
  cp -rp /usr/include/{eigen3,fast_float,nlohmann,stb,tiny_gltf.h,xxhash.h} "$prefix/include/"
  cp -rp /usr/share/eigen3 "$prefix/share/"
  cp -rp /usr/share/cmake/nlohmann_json "$prefix/share/cmake/"
fi
cd "$work"

# Fetches Debian 12's sources on any Debian, without changing what apt knows of: the originals, without
# Debian's changes, which are about shared libraries and documentation.
fetch() {
  local mirror apt
  mirror=$(apt-get indextargets --format '$(ORIGIN) $(SITE)' | awk '$1 == "Debian" { print $2; exit }')
  echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror bookworm main" \
    >sources.list
  mkdir -p lists/partial
  apt=(apt-get -q -o Dir::Etc::SourceList="$work/sources.list" -o Dir::Etc::SourceParts=-
    -o Dir::State::Lists="$work/lists" -o APT::Sandbox::User=root)
  "${apt[@]}" update && "${apt[@]}" source --download-only --tar-only "$@"
}

# unpack SOURCE: its archive, into the folder of that name.
unpack() {
  rm -rf "$1"
  mkdir "$1"
  tar -x --strip-components=1 -C "$1" -f "$1"_*.orig.tar.*
}

# with_cmake SOURCE FOLDER OPTION...: builds and installs what CMake builds in that folder of a source.
with_cmake() {
  local source=$1 folder=$1/$2
  shift 2
  cmake -S "$folder" -B "$source/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_INSTALL_LIBDIR=lib \
    -DBUILD_SHARED_LIBS=OFF -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DBUILD_TESTING=OFF \
    -DCMAKE_C_FLAGS_RELEASE="$optimized" -DCMAKE_CXX_FLAGS_RELEASE="$optimized" \
    -DCMAKE_C_FLAGS="$flags" -DCMAKE_CXX_FLAGS="$flags" -DCMAKE_EXPORT_NO_PACKAGE_REGISTRY=ON \
    "$@" &&
    cmake --build "$source/build" && cmake --install "$source/build"
}

for_windows() { [[ ${CMAKE_TOOLCHAIN_FILE-} == */windows.cmake ]]; }

# There each of the tools contains all that it needs, and small code counts for more.
optimized="-O3 -DNDEBUG"
! for_windows || optimized="-Os -DNDEBUG"

# Of each library, programs take the functions that they call, and no more (--gc-sections).
flags="-ffunction-sections -fdata-sections -ffile-prefix-map=$work="

# plain_c SOURCE LIBRARY HEADERS FILES: builds and installs a library of C files alone, whose own Makefile
# knows nothing of other systems, or whose CMakeLists.txt wants files that Debian's archive lacks.
plain_c() {
  cat >"$1/CMakeLists.txt" <<END && with_cmake "$1" .
cmake_minimum_required(VERSION 3.22)
project($2 C)
add_library($2 $4)
install(TARGETS $2)
install(FILES $3 TYPE INCLUDE)
END
}
build_giflib() {
  plain_c giflib gif gif_lib.h \
    "dgif_lib.c egif_lib.c gifalloc.c gif_err.c gif_hash.c openbsd-reallocarray.c"
}
build_zlib() {
  plain_c zlib z "zconf.h zlib.h" "adler32.c compress.c crc32.c deflate.c inffast.c inflate.c
    inftrees.c trees.c uncompr.c zutil.c"
}
build_googletest() { with_cmake googletest . -DBUILD_GMOCK=OFF; }
build_expat() {
  with_cmake expat expat -DEXPAT_SHARED_LIBS=OFF -DEXPAT_BUILD_TOOLS=OFF -DEXPAT_BUILD_EXAMPLES=OFF \
    -DEXPAT_BUILD_TESTS=OFF -DEXPAT_BUILD_DOCS=OFF
}
build_gflags() { with_cmake gflags . -DREGISTER_INSTALL_PREFIX=OFF; }
build_google-glog() {
  with_cmake google-glog . -DWITH_GFLAGS=OFF -DWITH_GTEST=OFF -DWITH_UNWIND=OFF
}
build_qhull() {
  with_cmake qhull . &&
    echo 'target_link_libraries(Qhull::qhullcpp INTERFACE Qhull::qhullstatic_r)' \
      >>"$prefix/lib/cmake/Qhull/QhullConfig.cmake"
}
build_openmesh() {
  # It would be shared as well, and its CMake package would name only that. The tools are not used.
  sed -i 's/SHAREDANDSTATIC/STATIC/' openmesh/src/OpenMesh/Core/CMakeLists.txt &&
    sed -i '/src\/OpenMesh\/Tools/d; /^export(/s/OpenMeshTools//' openmesh/CMakeLists.txt &&
    with_cmake openmesh . -DBUILD_APPS=OFF -DOPENMESH_DOCS=OFF
}
build_onetbb() {
  with_cmake onetbb . -DTBB_TEST=OFF -DTBBMALLOC_BUILD=OFF -DTBB_STRICT=OFF -DTBB_ENABLE_IPO=OFF \
    -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON &&
    sed -i '1i find_package(Threads REQUIRED)  # which the static library needs' \
      "$prefix/lib/cmake/TBB/TBBConfig.cmake"
}
# It expects Microsoft's compiler on Windows, and elsewhere a linker and C library that know ELF.
embree_for_mingw() {
  sed -i 's/INCLUDE (msvc)/INCLUDE (gnu)/' embree/CMakeLists.txt &&
    sed -i 's/ -z [a-z ]*//g; s/ -pie//; s/ -D_FORTIFY_SOURCE=2//; s/ -O3/ -Os/' \
      embree/common/cmake/gnu.cmake &&
    sed -i '/embree\.rc/d' embree/kernels/CMakeLists.txt
}
build_embree() {
  # A static Embree would install a target of an older TBB, and a manual that Debian's archive lacks. Of
  # the geometries it has those that shapespace draws and searches, of curves straight tubes alone; with
  # instructions of any processor.
  sed -i '/^IF (EMBREE_STATIC_LIB)/,/^ENDIF()/d' embree/common/cmake/installTBB.cmake &&
    sed -i '/readme\.pdf/d' embree/common/cmake/package.cmake &&
    sed -i '/vtbl\[/{/GTY_SPHERE_POINT\|GTY_ROUND_LINEAR_CURVE/!d}' \
      embree/kernels/geometry/curve_intersector_virtual_*.cpp &&
    sed -i '/case .* new CurveGeometryISA/d' embree/kernels/common/scene_curves.cpp &&
    { ! for_windows || embree_for_mingw; } &&
    with_cmake embree . -DEMBREE_STATIC_LIB=ON -DEMBREE_TUTORIALS=OFF -DEMBREE_ISPC_SUPPORT=OFF \
      -DEMBREE_RAY_PACKETS=OFF -DEMBREE_GEOMETRY_QUAD=OFF -DEMBREE_GEOMETRY_SUBDIVISION=OFF \
      -DEMBREE_GEOMETRY_INSTANCE=OFF -DEMBREE_GEOMETRY_GRID=OFF -DEMBREE_MAX_ISA=SSE2
}
build_openblas() {
  # What shapespace calls is of doubles, and of one thread, while several threads call at once. On
  # Windows the kernels for Haswell write where they must not, and those for Sandy Bridge gain 2 % of a
  # solve's time.
  local for_processors=(DYNAMIC_ARCH=1 DYNAMIC_LIST="NEHALEM SANDYBRIDGE HASWELL SKYLAKEX")
  ! for_windows || for_processors=(DYNAMIC_ARCH=0 CC=x86_64-w64-mingw32-gcc-posix HOSTCC=gcc CROSS=1
    CROSS_SUFFIX=x86_64-w64-mingw32-)
  make -C openblas -j "$(nproc)" libs "${for_processors[@]}" TARGET=NEHALEM \
    NOFORTRAN=1 NO_LAPACKE=1 NO_CBLAS=1 USE_THREAD=0 USE_LOCKING=1 \
    BUILD_SINGLE=1 BUILD_DOUBLE=1 COMMON_OPT="-O2 $flags" &&
    cp openblas/libopenblas*-r*.a "$prefix/lib/libopenblas.a"
}
build_ceres-solver() {
  # Its functions and those of shapespace share templates of Eigen, so both allocate in the same way
  # (lib/CMakeLists.txt).
  local flags="$flags -DEIGEN_MAX_ALIGN_BYTES=16 -DEIGEN_MALLOC_ALREADY_ALIGNED=1"
  with_cmake ceres-solver . -DSUITESPARSE=OFF -DCXSPARSE=OFF -DEIGENSPARSE=ON -DLAPACK=OFF -DCUDA=OFF \
    -DGFLAGS=OFF -DSCHUR_SPECIALIZATIONS=OFF -DBUILD_EXAMPLES=OFF -DBUILD_BENCHMARKS=OFF \
    -DPROVIDE_UNINSTALL_TARGET=OFF
}

missing=()
for library in "${libraries[@]}"; do
  [[ -e $library.built ]] || missing+=("$library")
done
((${#missing[@]})) || exit 0
fetch "${missing[@]}" >fetch.log 2>&1 ||
  { echo "static_libraries.sh: $(tail -1 fetch.log)" >&2; exit 1; }
for library in "${missing[@]}"; do
  echo "static_libraries.sh: $library ($SECONDS s)"
  { unpack "$library" && "build_$library"; } >"$library.log" 2>&1 || {
    tail -n 30 "$library.log" >&2
    echo "static_libraries.sh: $library could not be built; all that was said is in $work/$library.log" >&2
    exit 1
  }
  cp "$(find "$library" -maxdepth 2 -regex '.*/\(LICENSE\|COPYING\)\(\.txt\)?' | sort | head -1)" \
    "$prefix/licenses/$library"
  rm -rf "${library:?}/build"
  touch "$library.built"
done
