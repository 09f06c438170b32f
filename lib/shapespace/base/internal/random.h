#ifndef SHAPESPACE_BASE_INTERNAL_RANDOM_H_
#define SHAPESPACE_BASE_INTERNAL_RANDOM_H_

#include <random>

namespace shapespace::internal {

/// A random number, uniformly distributed in [0, 1): the same on every machine, which the
/// distributions of the standard library are not.
inline double Uniform(std::mt19937_64* random) {
  return static_cast<double>((*random)() >> 11) * 0x1p-53;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_RANDOM_H_
