#include <shapespace/sparse/internal/one_thread.h>

// Eigen's kernels and a Ceres without SuiteSparse start no threads.

namespace shapespace::internal {

OneThread::OneThread() = default;
OneThread::~OneThread() = default;

}  // namespace shapespace::internal
