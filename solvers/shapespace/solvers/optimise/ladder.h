#ifndef SHAPESPACE_SOLVERS_OPTIMISE_LADDER_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_LADDER_H_

#include <memory>

#include <shapespace/base/progress.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>
#include <shapespace/solvers/geodesic.h>
#include <shapespace/solvers/transfer.h>

namespace shapespace::internal {

/// Root mean square distance of the surface from its centroid.
double Radius(const Shape& shape, const Eigen::VectorXd& weights);

/// The rungs between the shapes of a source and those of a target, all in the user's unit.
class Ladder {
 public:
  Ladder(std::shared_ptr<const Metric> metric, const LadderOptions& options);

  struct Rung {
    GeodesicResult geodesic;
    Shape from, next;  ///< of the source, as they are compared with the target
  };

  /// From a shape of the source to the target's; `next` is the source's after that.
  Rung Lay(const Shape& source, const Shape& next, const Shape& target, Progress* progress) const;

  /// Half way between the two.
  Shape Hybrid(const Rung& rung) const {
    return rung.geodesic.path.Placed((options_.rung_shapes + 1) / 2);
  }

  /// What `target` becomes as the source becomes its next shape. \throw SolverError.
  Shape Climb(const Rung& rung, const Shape& target, TransferSummary::Step* row,
              Progress* progress) const;

  /// The rotation that gives the target's surface, in the mean over it, the orientation that the
  /// source's has. Bodies of other proportions have their mass elsewhere, so that shapes which lie
  /// well on each other as a whole do not stand alike. The identity if options.align is off.
  Eigen::Matrix3d Uprighting(const Shape& first_source, const Shape& source,
                             const Shape& first_target, const Shape& target) const;

 private:
  // A rung without length: the target is the source's shape.
  bool HasNoLength(const Rung& rung) const;

  const std::shared_ptr<const Metric> metric_;
  const LadderOptions options_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_LADDER_H_
