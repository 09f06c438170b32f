#ifndef SHAPESPACE_SUMMARY_INTERNAL_CHECK_OPTIONS_H_
#define SHAPESPACE_SUMMARY_INTERNAL_CHECK_OPTIONS_H_

#include <shapespace/base/error.h>

// Checks of options that all solvers have.

namespace shapespace::internal {

/// \throw InvalidOptions.
inline void CheckTolerance(double tolerance) {
  if (!(tolerance > 0) || !(tolerance < 1)) {
    throw InvalidOptions("tolerance", "must be between 0 and 1");
  }
}

/// \throw InvalidOptions.
inline void CheckMaxIterations(int max_iterations) {
  if (max_iterations < 1) throw InvalidOptions("max_iterations", "must be 1 or more");
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SUMMARY_INTERNAL_CHECK_OPTIONS_H_
