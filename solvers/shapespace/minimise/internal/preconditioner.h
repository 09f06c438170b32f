#ifndef SHAPESPACE_MINIMISE_INTERNAL_PRECONDITIONER_H_
#define SHAPESPACE_MINIMISE_INTERNAL_PRECONDITIONER_H_

#include <vector>

#include <Eigen/SparseCore>

#include <shapespace/metric/metric.h>
#include <shapespace/path/energy.h>
#include <shapespace/sparse/internal/cholesky.h>

namespace shapespace::internal {

/// The greatest sum of 4 weight k^T k over an element's scalar rows k that the matrix below has;
/// stiffer elements are scaled down to it.
double StiffestElement(const Metric& metric, const std::vector<Shape>& poses);

/// The scalar m x m matrix that approximates the metric's matrix for each axis: the sum of 4 w k
/// k^T over the elements, where k are the coefficients of the features' stencils, averaged over
/// `poses`. If `quartic_segments` > 0, adds the trapezoid's quartic part for that many segments
/// between the first and the last pose.
Eigen::SparseMatrix<double> ScalarMetric(const Metric& metric, const std::vector<Shape>& poses,
                                         int quartic_segments);

/// The change of variables in which a path energy's Hessian approximates the identity; Ceres'
/// L-BFGS has no other way to use a preconditioner:
///   P = P_0 + s (C_T^{-T} x Q^T C^{-T}) y,
/// with T = C_T C_T^T the second difference in time and Q S Q^T = C C^T the scalar metric.
class ChangeOfVariables {
 public:
  /// `factor` is that of the scalar metric, by vertex; both are kept by reference.
  ChangeOfVariables(const Cholesky& factor, const PathEnergy& energy);

  /// Numbers in y: 3 m Inner(), no padding.
  int Size() const { return size_; }

  /// unknowns = origin + scale * (the linear map) y. Arrays of PathEnergy::Size(); y of Size().
  void Apply(const double* y, const double* origin, double scale, double* unknowns);
  /// y = scale * (the transposed map) gradient.
  void ApplyTranspose(const double* gradient, double scale, double* y);

 private:
  const Cholesky& factor_;
  int inner_, stride_, size_;
  int width_;                             // 3 inner_, padded for the factor's kernels
  std::vector<int> row_;                  // of PathEnergy, per row of the factor
  std::vector<double> diagonal_, below_;  // of C_T: reciprocals of the diagonal, subdiagonal
  std::vector<double> work_;
};

/// Computes steps from gradients: the inverse of S x T, with S and T as in ChangeOfVariables, on
/// the path energy's own rows. An optimiser that uses it needs no change of variables and applies
/// it once per step instead of twice per evaluation. Single precision is sufficient to choose a
/// direction.
class Preconditioner {
 public:
  /// `factor` is that of the scalar metric, by vertex; both are kept by reference.
  Preconditioner(const CholeskyFactor<float>& factor, const PathEnergy& energy);

  /// result = (S x T)^{-1} gradient; arrays of PathEnergy::Size(), which may be identical; the
  /// result's padding is zero. `unit` is approximately the square root of an energy; it keeps
  /// intermediate numbers within the range of a float.
  void Apply(const double* gradient, double unit, double* result);

 private:
  const CholeskyFactor<float>& factor_;
  int inner_, stride_;
  int width_;                     // 3 inner_, padded for the factor's kernels
  std::vector<int> row_;          // of PathEnergy, per row of the factor
  std::vector<double> diagonal_;  // reciprocals of the pivots of T
  std::vector<float> work_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MINIMISE_INTERNAL_PRECONDITIONER_H_
