#ifndef SHAPESPACE_GEODESIC_INTERNAL_RESOLUTION_H_
#define SHAPESPACE_GEODESIC_INTERNAL_RESOLUTION_H_

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <shapespace/geodesic/geodesic.h>
#include <shapespace/geodesic/internal/workload.h>
#include <shapespace/metric/metric.h>
#include <shapespace/numerics/internal/cholesky.h>
#include <shapespace/numerics/internal/minimise.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {

/// One level of a hierarchy, prepared for solving: its metric, the poses on it, and the factor of
/// its preconditioner.
class Resolution {
 public:
  /// `poses` are aligned, in the metric's unit: the path's poses unless others are set.
  Resolution(std::shared_ptr<const Metric> metric, std::vector<Shape> poses)
      : metric_(std::move(metric)), all_poses_(std::move(poses)), poses_(all_poses_) {}

  /// Sets the poses of the next path. The preconditioner remains that of the poses given first, so
  /// that a solve does not depend on earlier ones.
  void SetPoses(std::vector<Shape> poses);

  const std::shared_ptr<const Metric>& GetMetric() const { return metric_; }
  const Shape& Pose(int i) const { return poses_[i]; }

  /// Relaxes the inner ones of `shapes`, a path from pose `piece` to the next, and returns the
  /// summary's row. `enough` as in MinimiseOptions; 0 if no further solve follows.
  GeodesicSummary::Level Relax(int piece, double enough, const GeodesicOptions& options,
                               Workload* workload, std::vector<Shape>* shapes);

  /// The energy of a path of any number of shapes, unscaled.
  double Energy(const std::vector<Shape>& shapes, const GeodesicOptions& options);

  /// Its parts by feature, as PathEnergy::Parts.
  std::vector<double> EnergyParts(const std::vector<Shape>& shapes, const GeodesicOptions& options);

  double FactorSeconds() const { return factor_seconds_; }
  size_t FactorNonzeros() const {
    return factor_ ? factor_->NumNonzeros() : single_factor_ ? single_factor_->NumNonzeros() : 0;
  }

 private:
  template <typename Scalar>
  const CholeskyFactor<Scalar>& Factor(std::optional<CholeskyFactor<Scalar>>* factor, int piece,
                                       int inner);
  PathEnergy& EnergyOf(int inner, const GeodesicOptions& options);

  std::shared_ptr<const Metric> metric_;
  std::vector<Shape> all_poses_;  // for which the factor is computed
  std::vector<Shape> poses_;      // of the current path
  std::optional<PathEnergy> energy_;
  // Of the scalar metric, in the precision of the optimiser.
  std::optional<CholeskyFactor<double>> factor_;
  std::optional<CholeskyFactor<float>> single_factor_;
  std::pair<int, int> factor_key_ = {-1, -1};
  double factor_seconds_ = 0;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_INTERNAL_RESOLUTION_H_
