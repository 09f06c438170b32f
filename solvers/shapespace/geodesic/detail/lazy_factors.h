#ifndef SHAPESPACE_GEODESIC_DETAIL_LAZY_FACTORS_H_
#define SHAPESPACE_GEODESIC_DETAIL_LAZY_FACTORS_H_

#include <functional>
#include <mutex>
#include <optional>

#include <Eigen/SparseCore>

#include <shapespace/sparse/internal/cholesky.h>

namespace shapespace::internal {

/// The factors of a matrix in double and in single precision, each computed when it is first asked
/// for. Several threads may ask at a time; what they get depends on the matrix alone.
class LazyFactors {
 public:
  /// Calls `matrix` when a factor is computed.
  explicit LazyFactors(std::function<Eigen::SparseMatrix<double>()> matrix);

  /// `Scalar` is double or float. The reference is valid as long as the object.
  /// \throw as CholeskyFactor.
  template <typename Scalar>
  const CholeskyFactor<Scalar>& Get();

  /// Of one of the factors; 0 before there is one.
  size_t NumNonzeros() const;

 private:
  const std::function<Eigen::SparseMatrix<double>()> matrix_;
  mutable std::mutex mutex_;  // guards what follows
  std::optional<CholeskyFactor<double>> double_;
  std::optional<CholeskyFactor<float>> single_;
};

template <>
const CholeskyFactor<double>& LazyFactors::Get();
template <>
const CholeskyFactor<float>& LazyFactors::Get();

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_DETAIL_LAZY_FACTORS_H_
