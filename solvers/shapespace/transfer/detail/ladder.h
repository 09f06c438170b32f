#ifndef SHAPESPACE_TRANSFER_DETAIL_LADDER_H_
#define SHAPESPACE_TRANSFER_DETAIL_LADDER_H_

#include <memory>

#include <shapespace/base/progress.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>
#include <shapespace/transfer/transfer.h>

namespace shapespace::internal {

/// Root mean square distance of the surface from its centroid.
double Radius(const Shape& shape, const Eigen::VectorXd& weights);

/// Computes the rungs between shapes of a source and of a target, all in the user's unit.
class Ladder {
 public:
  Ladder(std::shared_ptr<const Metric> metric, const LadderOptions& options);

  struct Rung {
    GeodesicResult geodesic;
    Shape from, next;  ///< of the source, scaled and aligned for the comparison with the target
  };

  /// The rung from a shape of the source to the target's; `next` is the source's following shape.
  Rung BuildRung(const Shape& source, const Shape& next, const Shape& target,
                 Progress* progress) const;

  /// The midpoint of a rung.
  Shape Hybrid(const Rung& rung) const {
    return rung.geodesic.path.Placed((options_.rung_shapes + 1) / 2);
  }

  /// The target's next shape, which corresponds to the source's next shape.
  /// \throw SolverError.
  Shape TransportOnce(const Rung& rung, const Shape& target, TransferSummary::Step* row,
                      Progress* progress) const;

  /// The rotation that gives the target's surface the source's mean orientation. It is necessary
  /// because bodies with other proportions have a different distribution of area, so that aligned
  /// shapes may differ in orientation. The identity if options.align is off.
  Eigen::Matrix3d Uprighting(const Shape& first_source, const Shape& source,
                             const Shape& first_target, const Shape& target) const;

 private:
  // Whether source and target have the same shape, so that the rung has length zero.
  bool HasNoLength(const Rung& rung) const;

  const std::shared_ptr<const Metric> metric_;
  const LadderOptions options_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_TRANSFER_DETAIL_LADDER_H_
