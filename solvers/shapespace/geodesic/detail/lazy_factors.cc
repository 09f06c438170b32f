#include <shapespace/geodesic/detail/lazy_factors.h>

#include <utility>

namespace shapespace::internal {

LazyFactors::LazyFactors(std::function<Eigen::SparseMatrix<double>()> matrix)
    : matrix_(std::move(matrix)) {}

template <>
const CholeskyFactor<double>& LazyFactors::Get() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!double_) double_.emplace(matrix_());
  return *double_;
}

template <>
const CholeskyFactor<float>& LazyFactors::Get() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!single_) {
    if (double_) {
      single_.emplace(*double_);
    } else {
      single_.emplace(matrix_());
    }
  }
  return *single_;
}

size_t LazyFactors::NumNonzeros() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return double_ ? double_->NumNonzeros() : single_ ? single_->NumNonzeros() : 0;
}

}  // namespace shapespace::internal
