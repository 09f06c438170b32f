#ifndef SHAPESPACE_MATCHING_DETAIL_SPECTRUM_H_
#define SHAPESPACE_MATCHING_DETAIL_SPECTRUM_H_

#include <Eigen/Core>

#include <shapespace/matching/detail/laplacian.h>

namespace shapespace::internal {

/// The first eigenfunctions phi of a surface's Laplacian:
/// stiffness phi_i = values_i diag(areas) phi_i, with phi_i^T diag(areas) phi_j = 1 if i = j and 0
/// otherwise.
struct Spectrum {
  Eigen::VectorXd values;     ///< ascending; the first is 0
  Eigen::MatrixXd functions;  ///< n x count

  int Count() const { return static_cast<int>(values.size()); }
};

/// The first `count` eigenfunctions, or as many as there are vertices, of a connected surface of
/// area 1. By the block Lanczos method with inversion at a negative shift (G. Golub and R.
/// Underwood, "The block Lanczos method for computing eigenvalues", 1977), with complete
/// orthogonalisation. The same for any number of threads.
/// \throw SolverError if memory runs out.
Spectrum ComputeSpectrum(const Laplacian& laplacian, int count);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_SPECTRUM_H_
