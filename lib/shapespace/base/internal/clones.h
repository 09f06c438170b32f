#ifndef SHAPESPACE_BASE_INTERNAL_CLONES_H_
#define SHAPESPACE_BASE_INTERNAL_CLONES_H_

// Compiles a function for several instruction sets, one of which is selected when the
// program starts. A portable build without this is slower by a factor of two and more. Sanitizers
// cannot instrument the selection, and Windows does not have it.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(_WIN32) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SHAPESPACE_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define SHAPESPACE_CLONES
#endif

// Templates cannot be cloned; those inlined into a clone are compiled for its instruction set.
#define SHAPESPACE_INLINE inline __attribute__((always_inline))

// Before a loop: asserts that no iteration writes what another one reads, so that g++ may vectorise
// it. (clang checks this at run time.)
#if defined(__clang__)
#define SHAPESPACE_INDEPENDENT
#else
#define SHAPESPACE_INDEPENDENT _Pragma("GCC ivdep")
#endif

#endif  // SHAPESPACE_BASE_INTERNAL_CLONES_H_
