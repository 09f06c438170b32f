# Compiles for WebAssembly with Debian's emscripten, which needs NODE_PATH=/usr/share/nodejs in the
# environment (./dev wasm sets it); programs are run in Node.
set(NODE_JS_EXECUTABLE /usr/bin/node)
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
set(CMAKE_CROSSCOMPILING_EMULATOR ${NODE_JS_EXECUTABLE} --no-experimental-fetch)
# Nothing of this system is taken but what is installed under CMAKE_PREFIX_PATH.
list(APPEND CMAKE_FIND_ROOT_PATH ${CMAKE_PREFIX_PATH})
# Exceptions and vectors of WebAssembly itself, which all browsers have since 2023.
add_compile_options(-fwasm-exceptions -sSUPPORT_LONGJMP=wasm -msimd128 -Wno-unused-command-line-argument)
add_link_options(-fwasm-exceptions -sSUPPORT_LONGJMP=wasm)
# Ceres without threads and without glog.
set(CERES_THREADING_MODEL NO_THREADS CACHE STRING "")
set(MINIGLOG ON CACHE BOOL "")
