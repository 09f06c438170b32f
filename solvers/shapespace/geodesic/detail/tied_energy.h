#ifndef SHAPESPACE_GEODESIC_DETAIL_TIED_ENERGY_H_
#define SHAPESPACE_GEODESIC_DETAIL_TIED_ENERGY_H_

#include <vector>

#include <shapespace/geodesic/detail/thin_vertices.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {

/// A path energy as an objective of solvers in which some vertices have no unknowns of their own,
/// but move with three others, at the offset that they have at the start. Their entries of the
/// unknowns are not read, and those of the gradient are zero.
class TiedEnergy {
 public:
  /// `tied[i]` are the ties of inner shape i; `unknowns` is the start.
  TiedEnergy(PathEnergy* energy, const std::vector<std::vector<ThinVertices::Tied>>& tied,
             const std::vector<double>& unknowns);

  double operator()(const double* unknowns, double* gradient);

  /// Sets the entries of the tied vertices.
  void Follow(double* unknowns) const;

 private:
  struct Tie {
    size_t entry, corners[3];  // of x; y and z follow at `stride_`
    double weights[3], offset[3];
  };
  PathEnergy* energy_;
  size_t stride_;
  std::vector<Tie> ties_;
  std::vector<double> followed_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_DETAIL_TIED_ENERGY_H_
