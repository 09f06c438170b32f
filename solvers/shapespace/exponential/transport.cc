#include <shapespace/exponential/transport.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/exponential/detail/step_ceres.h>
#include <shapespace/exponential/internal/memory.h>
#include <shapespace/exponential/internal/metric_solver.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/metric/internal/cost_of_position.h>
#include <shapespace/summary/internal/check_options.h>
#include <shapespace/summary/internal/memory.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
namespace {

using internal::MetricSolver;

// Levi-Civita transport. J X of a tangent X lies in the range of J; transport maps the range of J_0
// to that of J_1 isometrically with least change. With the orthogonal projections P onto the two
// ranges,
//   J_1 Y = P_1 (3/2 - 1/2 P_0 P_1) J_0 X,
// the first step of the Newton-Schulz iteration for the isometry that is nearest to P_1.
class MetricTransport {
 public:
  MetricTransport(const Path& path, const FeatureMap& map, const TransportOptions& options)
      : path_(path),
        options_(options),
        map_(map),
        here_(std::make_unique<Place>(map_, path.shapes[0], std::make_unique<MetricSolver>())),
        unused_(std::make_unique<MetricSolver>()) {}

  /// Transports from path.shapes[i] to the next shape. The tangents are rotated as `Turn` says.
  void Carry(int i, std::vector<Tangent>* tangents, TransportSummary::Step* row) {
    Shape next = path_.shapes[i + 1];
    if (options_.align) {
      const RigidMotion back = FitRigidMotion(next, here_->shape, path_.metric->vertex_area);
      next = back(next);
      turn_ = back.rotation.transpose();
    }
    const std::unique_ptr<Place> from =
        std::exchange(here_, std::make_unique<Place>(map_, next, std::move(unused_)));
    const Place& to = *here_;
    for (Tangent& x : *tangents) {
      const Eigen::VectorXd change = from->derivative.Times(x);
      // The projections change vectors only slightly. Solving for the corrections is more accurate
      // than solving for the projected vectors.
      const double size = change.norm();
      const Tangent nearest =
          x + Solve(to, change - to.derivative.Times(x), size, row);  // J_1 of it is P_1 J_0 X
      const Tangent there_and_back =
          Solve(*from, to.derivative.Times(nearest) - change, size, row);  // P_0 P_1 J_0 X - J_0 X
      x = nearest - 0.5 * Solve(to, from->derivative.Times(there_and_back), size, row);
    }
    unused_ = std::move(from->solver);
  }

  /// Rotation of the path's shape against the frame of the tangents.
  const Eigen::Matrix3d& Turn() const { return turn_; }

 private:
  // A shape and the data for projections onto the range of J there.
  struct Place {
    Place(const FeatureMap& map, Shape at, std::unique_ptr<MetricSolver> metric_solver)
        : shape(std::move(at)),
          derivative(map.Derivative(shape)),
          solver(std::move(metric_solver)) {
      solver->Factor(derivative);
    }
    Shape shape;
    FeatureDerivative derivative;
    std::unique_ptr<MetricSolver> solver;
  };

  // The tangent whose image is nearest to `change`, to an error of options_.tolerance times `size`.
  Tangent Solve(const Place& place, const Eigen::VectorXd& change, double size,
                TransportSummary::Step* row) const {
    const Tangent right = place.derivative.TransposeTimes(change);
    const double length = place.solver->DualNorm(right);
    Tangent x = Tangent::Zero(3, right.cols());
    if (!(length > options_.tolerance * size)) return x;
    const MetricSolver::Result result = place.solver->SolveInEitherPrecision(
        place.derivative, place.derivative, right, options_.tolerance * size / length,
        options_.max_iterations, &x);
    row->krylov_iterations = std::max(row->krylov_iterations, result.iterations);
    row->residual = std::max(row->residual, result.residual * length / size);
    return x;
  }

  const Path& path_;
  const TransportOptions& options_;
  const FeatureMap& map_;
  std::unique_ptr<Place> here_;
  // Of the shape before: it knows the elimination order, which is the same for all shapes.
  std::unique_ptr<MetricSolver> unused_;
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
};

// The paper's transport: the tangent nearest to the previous one among those with <Y, gamma'> = C.
class ConstrainedProjection {
 public:
  ConstrainedProjection(const Path& path, const FeatureMap& map) : path_(path), map_(map) {}

  void Carry(int i, std::vector<Tangent>* tangents) {
    if (i == 0) {
      const Tangent normal = Normal(0);
      for (const Tangent& x : *tangents) constants_.push_back(x.cwiseProduct(normal).sum());
    }
    const Tangent normal = Normal(i + 1);
    for (size_t k = 0; k < tangents->size(); ++k) {
      Tangent& x = (*tangents)[k];
      x = internal::ProjectOntoConstraint(x, normal, constants_[k]);
    }
  }

 private:
  // G gamma' at shape i; at the last one, gamma' is that of the last segment.
  Tangent Normal(int i) const {
    const int begin = std::min(i, path_.NumShapes() - 2);
    const double time = path_.parameters[begin + 1] - path_.parameters[begin];
    const FeatureDerivative derivative = map_.Derivative(path_.shapes[i]);
    return derivative.TransposeTimes(
        derivative.Times((path_.shapes[begin + 1] - path_.shapes[begin]) / time));
  }

  const Path& path_;
  const FeatureMap& map_;
  std::vector<double> constants_;
};

std::vector<double> Norms(const FeatureMap& map, const Shape& shape,
                          const std::vector<Tangent>& tangents) {
  const FeatureDerivative derivative = map.Derivative(shape);
  std::vector<double> norms;
  for (const Tangent& x : tangents) norms.push_back(derivative.Times(x).norm());
  return norms;
}

}  // namespace

void TransportOptions::Validate() const {
  internal::CheckTolerance(tolerance);
  internal::CheckMaxIterations(max_iterations);
  internal::CheckMemoryLimit(memory_limit);
}

std::string TransportSummary::BriefReport() const {
  double change = 0;
  for (size_t k = 0; k < first_norm.size(); ++k) {
    if (first_norm[k] > 0) {
      change = std::max(change, std::abs(last_norm[k] / first_norm[k] - 1));
    }
  }
  return internal::Format("%s: %zu tangents over %zu segments; norms change by up to %.3g; %.2f s",
                          converged ? "converged" : "NOT CONVERGED", first_norm.size(),
                          steps.size(), change, total_seconds);
}

TransportResult Transport(const Path& path, const std::vector<Tangent>& tangents,
                          const TransportOptions& options, Progress* progress) {
  options.Validate();
  const internal::Stopwatch total;
  const Metric& metric = *path.metric;
  const int segments = path.NumShapes() - 1;
  if (segments < 1) throw MeshError("transport needs a path of at least two shapes");
  TransportResult result;
  for (const Tangent& x : tangents) {
    if (x.cols() != metric.connectivity->NumVertices() || !x.allFinite()) {
      throw MeshError("a tangent is not finite, or has another number of vertices than the path");
    }
    result.tangents.push_back(path.motions.front().rotation.transpose() * x / metric.unit);
  }
  const FeatureMap map(internal::WithCostOfPosition(path.metric, internal::kFreeBodyLambda));
  result.summary.estimated_bytes =
      internal::TransportBytes(map.GetMetric(), static_cast<int>(tangents.size()));
  internal::CheckMemory("this transport", result.summary.estimated_bytes, options.memory_limit,
                        "use a mesh of fewer vertices");
  result.summary.converged = true;
  result.summary.metric = DescribeMetric(map.GetMetric().options);
  result.summary.first_norm = Norms(map, path.shapes.front(), result.tangents);
  std::optional<MetricTransport> metric_transport;
  std::optional<ConstrainedProjection> projection;
  if (options.connection == TransportConnection::kLeviCivita) {
    metric_transport.emplace(path, map, options);
  } else {
    projection.emplace(path, map);
  }
  for (int i = 0; i < segments; ++i) {
    ReportProgress(progress, "transporting", i, segments);
    const internal::Stopwatch stopwatch;
    TransportSummary::Step row;
    if (metric_transport) {
      row.residual = 0;
      metric_transport->Carry(i, &result.tangents, &row);
      if (row.residual > options.tolerance) result.summary.converged = false;
    } else {
      projection->Carry(i, &result.tangents);
    }
    row.seconds = stopwatch.Seconds();
    result.summary.steps.push_back(row);
  }
  if (metric_transport) {
    for (Tangent& x : result.tangents) x = metric_transport->Turn() * x;
  }
  result.summary.last_norm = Norms(map, path.shapes[segments], result.tangents);
  for (Tangent& x : result.tangents) {
    x = metric.unit * (path.motions.back().rotation * x).eval();
    metric.connectivity->CopyToTwins(&x);
  }
  result.summary.total_seconds = total.Seconds();
  return result;
}

}  // namespace shapespace
