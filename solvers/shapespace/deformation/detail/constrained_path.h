#ifndef SHAPESPACE_DEFORMATION_DETAIL_CONSTRAINED_PATH_H_
#define SHAPESPACE_DEFORMATION_DETAIL_CONSTRAINED_PATH_H_

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <shapespace/contact/internal/path_contact.h>
#include <shapespace/deformation/detail/free_end_preconditioner.h>
#include <shapespace/metric/metric.h>
#include <shapespace/minimise/internal/minimise.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {

/// Paths on one mesh from a given shape to a last shape with constraints and penalties
/// (PositionConstraints): minimises
///   E(P) + (1 / n) sum_p pull_p |p_n - target_p|^2
/// over all of its n + 1 shapes but the first.
class ConstrainedPath {
 public:
  /// In the metric's unit; `rest` is the first shape of all paths.
  ConstrainedPath(std::shared_ptr<const Metric> metric, Shape rest, PositionConstraints constraints)
      : metric_(std::move(metric)), factors_(metric_, std::move(rest), std::move(constraints)) {}

  const std::shared_ptr<const Metric>& GetMetric() const { return metric_; }
  const Shape& Rest() const { return factors_.Rest(); }
  const FreeEndFactors& Factors() const { return factors_; }

  /// The energy of a path of any number of shapes, unscaled.
  double Energy(const std::vector<Shape>& shapes);

  /// How parts of the shapes repel each other.
  struct Contact {
    const ContactModel& model;
    double weight;  ///< of the potential, which is the mean over `motions`
    std::vector<PathContact::Motion> motions;
    int times;  ///< of each motion, at first
  };

  /// Relaxes `shapes`, the first of which does not move, by L-BFGS. Prescribed vertices keep their
  /// positions in `shapes`. `target` contains the targets of the penalties for the last shape; its
  /// other columns are not used. If `contact` is given, nothing touches during its motions, which
  /// must be so at the beginning.
  MinimiseResult Relax(const Shape& target, const MinimiseOptions& options,
                       std::vector<Shape>* shapes, const Contact* contact = nullptr);
  /// The same by Ceres' trust region on automatically differentiated residual blocks: for small
  /// meshes, and as an independent reference.
  /// \throw InvalidOptions as MinimiseTrustRegion.
  MinimiseResult RelaxByTrustRegion(const Shape& target, const MinimiseOptions& options,
                                    std::vector<Shape>* shapes) const;

 private:
  PathEnergy& EnergyOf(int segments);

  std::shared_ptr<const Metric> metric_;
  FreeEndFactors factors_;
  std::optional<PathEnergy> energy_;  // for the number of shapes used last
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_DEFORMATION_DETAIL_CONSTRAINED_PATH_H_
