#include <shapespace/solvers/transport.h>

#include <algorithm>
#include <cmath>

#include <shapespace/base/error.h>
#include <shapespace/base/stopwatch.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/solvers/check_options.h>
#include <shapespace/solvers/optimise/metric_solver.h>
#include <shapespace/solvers/optimise/step_ceres.h>
#include <shapespace/solvers/report.h>

namespace shapespace {
namespace {

using internal::MetricSolver;

// The metric's own: from path.shapes[i] to the next [J^T J_1] Y = J^T J_0 X, with J the mean of J_0
// and J_1, or, for the nearest, J_1 itself: then Y minimises |J_1 Y - J_0 X|.
class MetricTransport {
 public:
  MetricTransport(const Path& path, const TransportOptions& options)
      : path_(path), options_(options), map_(*path.metric) {}

  void Carry(int i, std::vector<Tangent>* tangents, TransportSummary::Step* row) {
    Shape from = path_.shapes[i];
    const Shape& to = path_.shapes[i + 1];
    if (options_.align) {
      const RigidMotion turn = FitRigidMotion(from, to, path_.metric->vertex_area);
      from = turn(from);
      for (Tangent& x : *tangents) x = turn.rotation * x;
    }
    const FeatureDerivative at_from = map_.Derivative(from), at_to = map_.Derivative(to);
    const FeatureDerivative left = options_.connection == Connection::kNearest
                                       ? at_to
                                       : FeatureDerivative::Blend(at_from, at_to, 0.5);
    solver_.Factor(left);
    for (Tangent& x : *tangents) {
      const Tangent right = left.TransposeTimes(at_from.Times(x));
      // What changes is little: solved for as a correction, it is found to more digits.
      const Tangent change = right - left.TransposeTimes(at_to.Times(x));
      const double scale = solver_.DualNorm(right), size = solver_.DualNorm(change);
      if (!(size > options_.tolerance * scale)) continue;
      Tangent correction;
      const MetricSolver::Result result =
          solver_.Solve(left, at_to, change, options_.tolerance * scale / size,
                        options_.max_iterations, &correction);
      x += correction;
      row->krylov_iterations = std::max(row->krylov_iterations, result.iterations);
      row->residual = std::max(row->residual, result.residual * size / scale);
    }
  }

 private:
  const Path& path_;
  const TransportOptions& options_;
  const FeatureMap map_;
  MetricSolver solver_;
};

// The paper's: the tangent nearest to the one before among those with <Y, gamma'> = C.
class ConstrainedProjection {
 public:
  explicit ConstrainedProjection(const Path& path) : path_(path), map_(*path.metric) {}

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
  // G gamma' at shape i; at the last one, gamma' is that of the segment before.
  Tangent Normal(int i) const {
    const int begin = std::min(i, path_.NumShapes() - 2);
    const double time = path_.parameters[begin + 1] - path_.parameters[begin];
    const FeatureDerivative derivative = map_.Derivative(path_.shapes[i]);
    return derivative.TransposeTimes(
        derivative.Times((path_.shapes[begin + 1] - path_.shapes[begin]) / time));
  }

  const Path& path_;
  const FeatureMap map_;
  std::vector<double> constants_;
};

std::vector<double> Norms(const Path& path, int shape, const std::vector<Tangent>& tangents) {
  const FeatureMap map(*path.metric);
  const FeatureDerivative derivative = map.Derivative(path.shapes[shape]);
  std::vector<double> norms;
  for (const Tangent& x : tangents) norms.push_back(derivative.Times(x).norm());
  return norms;
}

}  // namespace

void TransportOptions::Validate() const {
  internal::CheckTolerance(tolerance);
  internal::CheckMaxIterations(max_iterations);
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
  const Stopwatch total;
  const Metric& metric = *path.metric;
  const int segments = path.NumShapes() - 1;
  if (segments < 1) throw MeshError("a path of one shape leads nowhere");
  TransportResult result;
  for (const Tangent& x : tangents) {
    if (x.cols() != metric.connectivity->NumVertices() || !x.allFinite()) {
      throw MeshError("a tangent is not finite, or has another number of vertices than the path");
    }
    result.tangents.push_back(path.motions.front().rotation.transpose() * x / metric.unit);
  }
  result.summary.metric = Describe(metric.options);
  result.summary.first_norm = Norms(path, 0, result.tangents);
  MetricTransport metric_transport(path, options);
  ConstrainedProjection projection(path);
  for (int i = 0; i < segments; ++i) {
    ReportProgress(progress, "transporting", i, segments);
    const Stopwatch stopwatch;
    TransportSummary::Step row;
    if (options.connection == Connection::kConstrainedProjection) {
      projection.Carry(i, &result.tangents);
    } else {
      metric_transport.Carry(i, &result.tangents, &row);
      if (row.residual > options.tolerance) result.summary.converged = false;
    }
    row.seconds = stopwatch.Seconds();
    result.summary.steps.push_back(row);
  }
  result.summary.last_norm = Norms(path, segments, result.tangents);
  for (Tangent& x : result.tangents) {
    x = metric.unit * (path.motions.back().rotation * x).eval();
  }
  result.summary.total_seconds = total.Seconds();
  return result;
}

}  // namespace shapespace
