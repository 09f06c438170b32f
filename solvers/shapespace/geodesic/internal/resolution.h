#ifndef SHAPESPACE_GEODESIC_INTERNAL_RESOLUTION_H_
#define SHAPESPACE_GEODESIC_INTERNAL_RESOLUTION_H_

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <shapespace/geodesic/detail/lazy_factors.h>
#include <shapespace/geodesic/detail/thin_vertices.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/geodesic/internal/workload.h>
#include <shapespace/metric/metric.h>
#include <shapespace/minimise/internal/minimise.h>
#include <shapespace/path/energy.h>
#include <shapespace/sparse/internal/cholesky.h>

namespace shapespace::internal {

/// One level of a hierarchy, prepared for solving: what all solves on it share.
struct SharedLevel {
  /// `poses` are aligned, in the metric's unit; those for which the factors are computed.
  SharedLevel(std::shared_ptr<const Metric> metric, std::vector<Shape> poses);

  std::shared_ptr<const Metric> metric;
  /// Of the scalar metric without the trapezoid's quartic part.
  std::shared_ptr<LazyFactors> factors;
  std::shared_ptr<const ThinVertices> thin_vertices;
};

/// A level in one solve: the poses of its path, and arrays that the solve works on. Its results
/// depend on the shared level and the poses alone.
class Resolution {
 public:
  explicit Resolution(SharedLevel level);

  /// Sets the poses of the next path: aligned, in the metric's unit.
  void SetPoses(std::vector<Shape> poses);

  const std::shared_ptr<const Metric>& GetMetric() const { return metric_; }
  const Shape& Pose(int i) const { return poses_[i]; }

  /// Relaxes the inner ones of `shapes`, a path from pose `piece` to the next, and returns the
  /// summary's row. `enough` as in MinimiseOptions; 0 if no further solve follows.
  GeodesicSummary::Level Relax(int piece, double enough, const GeodesicOptions& options,
                               Workload* workload, std::vector<Shape>* shapes);

  /// Places the thin vertices of the inner ones of `shapes`, a path from pose `piece` to the next,
  /// as they lie in these poses, if this lowers the energy.
  void PlaceThinVertices(int piece, const GeodesicOptions& options, std::vector<Shape>* shapes);

  /// The energy of a path of any number of shapes, unscaled.
  double Energy(const std::vector<Shape>& shapes, const GeodesicOptions& options);

  /// Its parts by feature, as PathEnergy::Parts.
  std::vector<double> EnergyParts(const std::vector<Shape>& shapes, const GeodesicOptions& options);

  /// The factor with which L-BFGS on all threads is preconditioned.
  const CholeskyFactor<float>& SingleFactor(int piece, int inner) {
    return Factor<float>(piece, inner);
  }

  /// Time in which solves computed factors, or waited for another one that did.
  double FactorSeconds() const { return factor_seconds_; }
  size_t FactorNonzeros() const { return factors_->NumNonzeros(); }

 private:
  template <typename Scalar>
  const CholeskyFactor<Scalar>& Factor(int piece, int inner);
  PathEnergy& EnergyOf(int inner, const GeodesicOptions& options);

  std::shared_ptr<const Metric> metric_;
  std::vector<Shape> poses_;  // of the current path
  std::optional<PathEnergy> energy_;
  std::shared_ptr<LazyFactors> factors_;  // for the trapezoid those of a piece
  std::pair<int, int> factors_key_ = {-1, -1};
  double factor_seconds_ = 0;
  std::shared_ptr<const ThinVertices> thin_vertices_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_INTERNAL_RESOLUTION_H_
