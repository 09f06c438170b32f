#ifndef SHAPESPACE_BASE_CLONES_H_
#define SHAPESPACE_BASE_CLONES_H_

// Private: compiles a function for several instruction sets, of which one is chosen when the
// program starts: a portable build would otherwise lose a factor of two and more. Sanitizers cannot
// instrument the choice.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SHAPESPACE_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define SHAPESPACE_CLONES
#endif

// Templates, which cannot be cloned, are compiled for the instruction set of the clone that calls
// them if they are part of it.
#define SHAPESPACE_INLINE inline __attribute__((always_inline))

// Before a loop: no iteration writes what another one reads, so that g++ may vectorise it. (clang
// finds that out when the program runs.)
#if defined(__clang__)
#define SHAPESPACE_INDEPENDENT
#else
#define SHAPESPACE_INDEPENDENT _Pragma("GCC ivdep")
#endif

#endif  // SHAPESPACE_BASE_CLONES_H_
