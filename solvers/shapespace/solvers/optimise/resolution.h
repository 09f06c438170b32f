#ifndef SHAPESPACE_SOLVERS_OPTIMISE_RESOLUTION_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_RESOLUTION_H_

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <shapespace/metric/metric.h>
#include <shapespace/path/energy.h>
#include <shapespace/solvers/geodesic.h>
#include <shapespace/solvers/optimise/cholesky.h>
#include <shapespace/solvers/optimise/minimise.h>
#include <shapespace/solvers/optimise/workload.h>

namespace shapespace::internal {

/// How a minimisation ended, as summaries have it.
Termination Translate(Stop stop);

/// Rank of the L-BFGS approximation for so many unknowns.
int HistoryRank(double unknowns);

/// One level of a hierarchy, ready to be solved on: the metric and the poses there, and the factor
/// of its preconditioner.
class Resolution {
 public:
  /// `poses` are aligned, in the metric's unit: those of the path, unless others are set.
  Resolution(std::shared_ptr<const Metric> metric, std::vector<Shape> poses)
      : metric_(std::move(metric)), all_poses_(std::move(poses)), poses_(all_poses_) {}

  /// Other poses to lead a path through. The preconditioner stays that of the first ones, so that a
  /// solve does not depend on the solves before it.
  void SetPoses(std::vector<Shape> poses);

  const std::shared_ptr<const Metric>& GetMetric() const { return metric_; }
  const Shape& Pose(int i) const { return poses_[i]; }

  /// Relaxes the inner ones of `shapes`, a path from pose `piece` to the next, and says how it
  /// went. `enough` as in MinimiseOptions; 0 for the last solve on the way.
  GeodesicSummary::Level Relax(int piece, double enough, const GeodesicOptions& options,
                               Workload* workload, std::vector<Shape>* shapes);

  /// The energy of a path of any number of shapes, unscaled.
  double Energy(const std::vector<Shape>& shapes, const GeodesicOptions& options);

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
  std::vector<Shape> all_poses_;      // which the factor is made for
  std::vector<Shape> poses_;          // of the path
  std::optional<PathEnergy> energy_;  // of the number of inner shapes used last
  // Of the scalar metric, in the precision that the optimiser takes.
  std::optional<CholeskyFactor<double>> factor_;
  std::optional<CholeskyFactor<float>> single_factor_;
  std::pair<int, int> factor_key_ = {-1, -1};
  double factor_seconds_ = 0;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_RESOLUTION_H_
