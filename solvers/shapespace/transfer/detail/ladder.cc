#include <shapespace/transfer/detail/ladder.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/hierarchy/internal/detail.h>
#include <shapespace/mesh/rigid_motion.h>

namespace shapespace::internal {
namespace {

// Small enough that a copy of the source reproduces its motion to ten digits.
constexpr double kStepTolerance = 1e-12;
// The transfer has estimated its memory as a whole.
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

Path TwoShapes(const std::shared_ptr<const Metric>& metric, const Shape& from, const Shape& to) {
  Path path;
  path.metric = metric;
  path.shapes = {from / metric->unit, to / metric->unit};
  path.parameters = {0, 1};
  path.motions.resize(2);
  path.poses = {0, 1};
  return path;
}

// Applies the path's rigid motions to its shapes.
void TurnShapes(Path* path) {
  for (int i = 0; i < path->NumShapes(); ++i) {
    path->shapes[i] = path->motions[i].rotation * path->shapes[i];
    path->motions[i].rotation.setIdentity();
  }
}

}  // namespace

double Radius(const Shape& shape, const Eigen::VectorXd& weights) {
  const Eigen::Vector3d centre = Centroid(shape, weights);
  const Eigen::VectorXd squares = (shape.colwise() - centre).colwise().squaredNorm().transpose();
  return std::sqrt(squares.dot(weights) / weights.sum());
}

Ladder::Ladder(std::shared_ptr<const Metric> metric, const LadderOptions& options)
    : metric_(std::move(metric)), options_(options) {}

Ladder::Rung Ladder::BuildRung(const Shape& source, const Shape& next, const Shape& target,
                               Progress* progress) const {
  const Eigen::VectorXd& weights = metric_->vertex_area;
  const double scale = options_.scale ? Radius(target, weights) / Radius(source, weights) : 1;
  RigidMotion onto;
  if (options_.align) onto = FitRigidMotion(scale * source, target, weights);
  Rung rung;
  rung.from = onto(scale * source);
  rung.next = onto(scale * next);
  GeodesicOptions geodesic;
  geodesic.shapes = options_.rung_shapes;
  geodesic.tolerance = options_.tolerance;
  geodesic.memory_limit = kUnlimited;
  rung.geodesic = Interpolate(metric_, {rung.from, target}, geodesic, progress);
  if (rung.geodesic.summary.termination == Termination::kCancelled) throw Cancelled();
  if (!options_.align) TurnShapes(&rung.geodesic.path);
  return rung;
}

bool Ladder::HasNoLength(const Rung& rung) const {
  return options_.align && rung.geodesic.summary.energy < GeodesicSummary::kZeroEnergy;
}

Shape Ladder::TransportOnce(const Rung& rung, const Shape& target, TransferSummary::Step* row,
                            Progress* progress) const {
  const GeodesicSummary& geodesic = rung.geodesic.summary;
  row->ratio = geodesic.Ratio();
  row->warnings = geodesic.warnings;
  // For a rung of length zero, the target's step equals the source's.
  if (HasNoLength(rung)) {
    row->converged = row->on_mesh = true;
    return rung.next + (target - rung.from);
  }
  TransportOptions transport;
  transport.connection = options_.connection;
  transport.align = options_.align;
  transport.memory_limit = kUnlimited;
  const Tangent velocity = InitialVelocity(TwoShapes(metric_, rung.from, rung.next));
  const TransportResult transported =
      Transport(rung.geodesic.path, {velocity}, transport, progress);
  const double before = transported.summary.first_norm[0], after = transported.summary.last_norm[0];
  row->norm_change = before > 0 ? after / before - 1 : 0;
  ExponentialOptions exponential;
  exponential.tolerance = kStepTolerance;
  const ExponentialResult step =
      Extrapolate(metric_, target, transported.tangents[0], 1, exponential, progress);
  if (step.summary.ending != ExponentialSummary::Ending::kComplete) {
    throw SolverError(step.summary.stopped);
  }
  row->iterations = step.summary.steps[0].iterations;
  row->on_mesh = step.summary.steps[0].vertices == step.summary.vertices;
  row->converged = geodesic.termination == Termination::kConverged &&
                   transported.summary.converged && (!row->on_mesh || step.summary.Converged());
  return step.path.Placed(1);
}

Eigen::Matrix3d Ladder::Uprighting(const Shape& first_source, const Shape& source,
                                   const Shape& first_target, const Shape& target) const {
  if (!options_.align) return Eigen::Matrix3d::Identity();
  const Connectivity& connectivity = *metric_->connectivity;
  const auto is = VertexRotations(connectivity, first_target, target);
  const auto wanted = VertexRotations(connectivity, first_source, source);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (size_t v = 0; v < is.size(); ++v) {
    sum += metric_->vertex_area(v) * is[v] * wanted[v].transpose();
  }
  return ProcrustesRotation(sum);
}

}  // namespace shapespace::internal
