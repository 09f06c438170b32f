#include <shapespace/exponential/exponential.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/contact/internal/contact_model.h>
#include <shapespace/contact/internal/slide.h>
#include <shapespace/exponential/detail/shooter.h>
#include <shapespace/exponential/detail/step_ceres.h>
#include <shapespace/hierarchy/internal/detail.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/metric/internal/cost_of_position.h>
#include <shapespace/summary/internal/check_options.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
namespace {

using internal::InitialState;

// Computes the next shape and fills in the fields of the summary's row that concern the solve.
using NextShape = std::function<Shape(ExponentialSummary::Step*)>;

// The path ends if in one step more than this share of the surface turns over, or if an edge
// shrinks to less than this share of its length in the first shape.
constexpr double kInvertedShare = 1e-2, kVanishedEdge = 1e-5;

// The paper's scheme: Euler steps, after each of which the velocity is found from (7) at the new
// shape.
class FirstIntegral {
 public:
  FirstIntegral(const std::shared_ptr<const Metric>& metric, const Shape& start,
                const Tangent& velocity, const ExponentialOptions& options)
      : map_(metric), options_(options), shape_(start), velocity_(velocity) {
    const FeatureDerivative derivative = map_.Derivative(start);
    constants_ = velocity.cwiseProduct(derivative.TransposeTimes(derivative.Times(velocity)));
  }

  Shape Next(ExponentialSummary::Step* row) {
    shape_ += velocity_;
    const internal::StepResult result =
        internal::SolveFirstIntegral(map_, shape_, constants_, options_.first_integral_solver,
                                     options_.tolerance, options_.max_iterations, &velocity_);
    row->converged = result.converged;
    row->iterations = result.iterations;
    row->residual = result.residual;
    row->vertices = static_cast<int>(shape_.cols());
    map_.GetMetric().connectivity->CopyToTwins(&velocity_);
    return shape_;
  }

 private:
  FeatureMap map_;
  const ExponentialOptions options_;
  Shape shape_;
  Tangent velocity_, constants_;
};

struct Momenta {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
  double linear_scale = 0, angular_scale = 0;
};

// The discrete momenta of a segment that starts at `from` and on which Phi changes by `change`: the
// two sums that are conserved because of the invariance under translations and rotations.
Momenta MeasureMomenta(const FeatureMap& map, const Shape& from, const Eigen::VectorXd& change) {
  const Tangent momentum = map.Derivative(from).TransposeTimes(change);
  Momenta result;
  result.linear = momentum.rowwise().sum();
  for (int v = 0; v < from.cols(); ++v) {
    const Eigen::Vector3d p = from.col(v), q = momentum.col(v);
    result.angular += p.cross(q);
    result.linear_scale += q.norm();
    result.angular_scale += p.norm() * q.norm();
  }
  return result;
}

double Drift(const Momenta& a, const Momenta& b) {
  const auto share = [](const Eigen::Vector3d& difference, double scale) {
    return scale > 0 ? difference.norm() / scale : 0;
  };
  return std::max(share(b.linear - a.linear, a.linear_scale),
                  share(b.angular - a.angular, a.angular_scale));
}

// Measures the change of edge lengths since the first shape.
void MeasureEdges(const Metric& metric, const Shape& first, const Shape& shape,
                  ExponentialSummary::Step* row) {
  const Eigen::Matrix2Xi& edges = metric.connectivity->Edges();
  double squares = 0, area = 0;
  row->edge_max = 0;
  for (int e = 0; e < edges.cols(); ++e) {
    const double before = (first.col(edges(1, e)) - first.col(edges(0, e))).norm();
    if (before == 0) continue;
    const double change =
        std::abs((shape.col(edges(1, e)) - shape.col(edges(0, e))).norm() / before - 1);
    squares += metric.edge_area(e) * change * change;
    area += metric.edge_area(e);
    row->edge_max = std::max(row->edge_max, change);
  }
  row->edge_rms = area > 0 ? std::sqrt(squares / area) : 0;
}

// The share of the surface whose triangles rotate in this step by more than a right angle relative
// to the rotation of their neighbourhood.
double InvertedShare(const Metric& metric, const Shape& before, const Shape& after) {
  const Connectivity& connectivity = *metric.connectivity;
  if (connectivity.NumTriangles() == 0) return 0;
  const std::vector<Eigen::Matrix3d> turns = internal::VertexRotations(connectivity, before, after);
  double inverted = 0, all = 0;
  for (int f = 0; f < connectivity.NumTriangles(); ++f) {
    const Eigen::Vector3i t = connectivity.Triangles().col(f);
    const Eigen::Vector3d n = internal::AreaNormal(before, t);
    const Eigen::Vector3d expected = (turns[t(0)] + turns[t(1)] + turns[t(2)]) * n;
    all += n.norm();
    if (expected.dot(internal::AreaNormal(after, t)) < 0) inverted += n.norm();
  }
  return all > 0 ? inverted / all : 0;
}

// The reason why a path must end before `shape`; empty if there is none.
std::string WhyDegenerate(const Metric& metric, const Shape& start, const Shape& shape,
                          const ExponentialSummary::Step& row) {
  if (!shape.allFinite()) {
    return "a coordinate is not finite: the steps are too large for this integrator";
  }
  if (row.inverted > kInvertedShare) {
    return std::to_string(std::lround(100 * row.inverted)) +
           "% of the surface turn inside out; the motion cannot be continued";
  }
  const Eigen::Matrix2Xi& edges = metric.connectivity->Edges();
  for (int e = 0; e < edges.cols(); ++e) {
    const double before = (start.col(edges(1, e)) - start.col(edges(0, e))).norm();
    const double now = (shape.col(edges(1, e)) - shape.col(edges(0, e))).norm();
    if (now < kVanishedEdge * before) {
      return "the edge between vertices " + std::to_string(edges(0, e) + 1) + " and " +
             std::to_string(edges(1, e) + 1) + " vanishes; the motion cannot be continued";
    }
  }
  return {};
}

// Appends `steps` shapes after the last one of the result's path, `step` apart in time; ends before
// a step with contact unless `contact` is null.
void March(const NextShape& next, int steps, double step, const internal::ContactModel* contact,
           Progress* progress, ExponentialResult* result) {
  Path& path = result->path;
  ExponentialSummary& summary = result->summary;
  const Metric& metric = *path.metric;
  const FeatureMap map(path.metric);
  const Shape start = path.shapes.back();
  Momenta first;
  for (int i = 0; i < steps; ++i) {
    if (progress != nullptr) progress->ReportShare(static_cast<double>(i) / steps);
    const internal::Stopwatch stopwatch;
    ExponentialSummary::Step row;
    const Shape& current = path.shapes.back();
    row.t = path.parameters.back() + step;
    Shape shape;
    try {
      ReportProgress(progress, "shooting", i, steps);
      shape = next(&row);
    } catch (const SolverError& error) {
      summary.stopped = error.what();
    } catch (const Cancelled& cancelled) {
      if (i == 0) throw;
      summary.ending = ExponentialSummary::Ending::kCancelled;
      summary.stopped = "step " + std::to_string(i + 1) + ": " + cancelled.what();
      return;
    }
    if (summary.stopped.empty()) {
      if (shape.allFinite()) row.inverted = InvertedShare(metric, current, shape);
      summary.stopped = WhyDegenerate(metric, start, shape, row);
    }
    if (!summary.stopped.empty()) {
      summary.ending = ExponentialSummary::Ending::kDegenerate;
      summary.stopped = "step " + std::to_string(i + 1) + ": " + summary.stopped;
      return;
    }
    if (contact != nullptr && !contact->IsFree(current, shape)) {
      summary.ending = ExponentialSummary::Ending::kContact;
      summary.stopped = "step " + std::to_string(i + 1) + ": parts of the body touch";
      return;
    }
    const Eigen::VectorXd change = map.Values(shape) - map.Values(current);
    row.energy = change.squaredNorm() / (step * step);
    const Momenta momenta = MeasureMomenta(map, current, change);
    if (i == 0) first = momenta;
    row.momentum_drift = Drift(first, momenta);
    MeasureEdges(metric, path.shapes.front(), shape, &row);
    row.seconds = stopwatch.Seconds();
    summary.steps.push_back(row);

    const RigidMotion motion =
        path.NumShapes() > 1
            ? InterpolateMotion(path.motions[path.NumShapes() - 2], path.motions.back(), 2)
            : path.motions.back();
    path.motions.push_back(motion);
    path.parameters.push_back(row.t);
    path.shapes.push_back(std::move(shape));
  }
}

void CheckSteps(int steps) {
  if (steps < 1) throw InvalidOptions("steps", "must be 1 or more");
}

// The energy of segments is constant along a geodesic. If it grows by this factor, the steps are
// too long for the integrator, or lifted detail has acquired momentum.
constexpr double kRisen = 2;

// Appends warnings for the user.
void Warn(const Metric& metric, ExponentialSummary* summary) {
  int coarse = 0, nearest = 0, open = 0;
  double inverted = 0, energy = 0;
  for (const ExponentialSummary::Step& step : summary->steps) {
    if (step.vertices == 0) {
      ++nearest;
    } else if (step.vertices < summary->vertices) {
      ++coarse;
    } else if (!step.converged) {
      ++open;
    }
    inverted = std::max(inverted, step.inverted);
    energy = std::max(energy, step.energy);
  }
  const auto warn = [&](const std::string& text) { summary->warnings.push_back(text); };
  const std::string of = " of " + std::to_string(summary->steps.size()) + " steps ";
  if (coarse > 0) {
    warn(
        std::to_string(coarse) + of +
        "have no solution on the mesh itself, because some triangles cannot continue their motion: "
        "they were solved on a coarser mesh and lifted with its detail" +
        (metric.options.strain > 0
             ? ""
             : "; on paths under the metric strain every triangle can continue"));
  }
  if (nearest > 0) {
    warn(std::to_string(nearest) + of +
         "have no solution on any resolution: the nearest shape in feature space was taken, which "
         "slows the motion down");
  }
  if (open > 0) warn(std::to_string(open) + of + "did not converge");
  if (inverted > 0) {
    warn("up to " + std::to_string(100 * inverted) +
         "% of the surface turned over in a step: check the pictures");
  }
  if (!summary->steps.empty()) {
    const double first = summary->steps.front().energy;
    if (energy > kRisen * first) {
      warn("the energy of a segment, constant on a geodesic, rises to " +
           internal::Format("%.3g", energy / first) + " times its first value");
    }
  }
  using Ending = ExponentialSummary::Ending;
  if (summary->ending != Ending::kComplete && summary->ending != Ending::kContact) {
    warn("stopped early, at " + summary->stopped);
  }
}

// Lets the shapes of all steps slide where the body passes through itself.
void Slide(const std::shared_ptr<const Metric>& metric, Progress* progress,
           ExponentialResult* result) {
  std::vector<Shape>& shapes = result->path.shapes;
  ExponentialSummary& summary = result->summary;
  const auto start = shapes.end() - static_cast<std::ptrdiff_t>(summary.steps.size()) - 1;
  std::vector<Shape> made(start, shapes.end());
  try {
    internal::SlideResult slide = internal::SlideAtContact(metric, progress, &made);
    std::move(made.begin(), made.end(), start);
    summary.uncertified_segments = slide.uncertified_segments;
    summary.contact_distance = slide.contact_distance;
    for (std::string& warning : slide.warnings) summary.warnings.push_back(std::move(warning));
  } catch (const Cancelled& cancelled) {
    summary.ending = ExponentialSummary::Ending::kCancelled;
    summary.stopped = std::string("contact: ") + cancelled.what();
  }
}

// Continues the result's path, whose last shape is that of `initial_state`.
void Shoot(InitialState initial_state, int steps, double step, const ExponentialOptions& options,
           Progress* progress, ExponentialResult* result) {
  const internal::Stopwatch total;
  Path& path = result->path;
  ExponentialSummary& summary = result->summary;
  const std::shared_ptr<const Metric> metric =
      internal::WithCostOfPosition(path.metric, internal::kFreeBodyLambda);
  summary.ending = ExponentialSummary::Ending::kComplete;
  summary.integrator = options.integrator;
  summary.vertices = metric->connectivity->NumVertices();
  summary.requested_steps = steps;
  summary.metric = DescribeMetric(metric->options);
  if (metric->options.discretization == Discretization::kTrapezoid) {
    summary.warnings.push_back(
        "the path was made in trapezoid form, in which geodesics cannot be shot: it is continued "
        "in midpoint form");
  }

  std::optional<internal::ContactModel> model;
  if (options.stop_at_contact) {
    model.emplace(metric, std::vector<Shape>{path.shapes.back()},
                  internal::ContactModel::Intersections::kExempt);
    if (model->NumIntersections() > 0) {
      summary.warnings.push_back("the body intersects itself where the path begins (" +
                                 std::to_string(model->NumIntersections()) +
                                 " pairs of triangles); contact is not looked for there");
    }
  }
  const internal::ContactModel* const contact = model ? &*model : nullptr;
  const bool discrete = initial_state.previous.size() > 0;
  switch (options.integrator) {
    case GeodesicIntegrator::kVariational: {
      internal::Shooter shooter(metric, {path.shapes.front(), initial_state.shape}, options, [&] {
        ReportProgress(progress, "shooting", static_cast<int>(summary.steps.size()), steps);
      });
      const FeatureMap map(metric);
      initial_state.speed =
          discrete ? (map.Values(initial_state.shape) - map.Values(initial_state.previous)).norm()
                   : map.Derivative(initial_state.shape).Times(initial_state.velocity).norm();
      const auto next = [&](ExponentialSummary::Step* row) {
        Shape shape = shooter.Next(initial_state, row);
        if (row->vertices == summary.vertices) {
          initial_state.velocity.resize(3, 0);
          initial_state.previous = std::exchange(initial_state.shape, shape);
        } else {
          initial_state = shooter.Restart(initial_state.shape, shape, initial_state.speed);
        }
        return shape;
      };
      March(next, steps, step, contact, progress, result);
      summary.factorisations = shooter.NumFactorisations();
      summary.factor_seconds = shooter.FactorSeconds();
      break;
    }
    case GeodesicIntegrator::kFirstIntegral: {
      FirstIntegral scheme(
          metric, discrete ? initial_state.previous : initial_state.shape,
          discrete ? initial_state.shape - initial_state.previous : initial_state.velocity,
          options);
      ExponentialSummary::Step unused;
      if (discrete) scheme.Next(&unused);  // its first step is the last segment of the path
      March([&](ExponentialSummary::Step* row) { return scheme.Next(row); }, steps, step, contact,
            progress, result);
      break;
    }
  }
  if (options.slide_at_contact && !summary.steps.empty()) Slide(metric, progress, result);
  path.extrapolated += static_cast<int>(summary.steps.size());
  path.converged = path.converged && summary.Converged();
  Warn(*metric, &summary);
  summary.total_seconds = total.Seconds();
}

}  // namespace

void ExponentialOptions::Validate() const {
  internal::CheckTolerance(tolerance);
  internal::CheckMaxIterations(max_iterations);
  if (stop_at_contact && slide_at_contact) {
    throw InvalidOptions("slide_at_contact", "goes without stop_at_contact");
  }
}

ExponentialResult Extrapolate(const Path& path, int steps, const ExponentialOptions& options,
                              Progress* progress) {
  options.Validate();
  CheckSteps(steps);
  if (path.NumShapes() < 2) throw MeshError("a path needs at least two shapes to have a direction");
  ExponentialResult result;
  result.path = path;
  result.path.provenance += "; extrapolated";
  const int last = path.NumShapes() - 1;
  Shoot({path.shapes[last], path.shapes[last - 1], {}, 0}, steps,
        path.parameters[last] - path.parameters[last - 1], options, progress, &result);
  return result;
}

ExponentialResult Extrapolate(const std::shared_ptr<const Metric>& metric, const Shape& shape,
                              const Tangent& velocity, int steps, const ExponentialOptions& options,
                              Progress* progress) {
  options.Validate();
  CheckSteps(steps);
  const auto check = [&](const Eigen::Matrix3Xd& matrix, const char* name) {
    if (matrix.cols() != metric->connectivity->NumVertices() || !matrix.allFinite()) {
      throw MeshError(std::string("the ") + name +
                      " is not finite, or has another number of vertices than the metric");
    }
  };
  check(shape, "shape");
  check(velocity, "velocity");
  ExponentialResult result;
  Path& path = result.path;
  path.metric = metric;
  RigidMotion place;
  place.translation = Centroid(shape, metric->vertex_area);
  path.motions = {place};
  path.shapes = {(shape.colwise() - place.translation) / metric->unit};
  path.parameters = {0};
  path.poses = {0};
  path.provenance = "shot from a shape";
  Shoot({path.shapes[0], {}, velocity / (metric->unit * steps), 0}, steps, 1.0 / steps, options,
        progress, &result);
  return result;
}

Shape Exponential(const std::shared_ptr<const Metric>& metric, const Shape& shape,
                  const Tangent& velocity, int steps, const ExponentialOptions& options,
                  Progress* progress) {
  const ExponentialResult result = Extrapolate(metric, shape, velocity, steps, options, progress);
  const ExponentialSummary& summary = result.summary;
  if (summary.ending == ExponentialSummary::Ending::kCancelled) throw Cancelled();
  if (summary.ending != ExponentialSummary::Ending::kComplete) {
    throw SolverError("the exponential map stopped early, at " + summary.stopped);
  }
  if (!summary.Converged()) {
    throw SolverError(
        "the exponential map is not exact: some steps did not converge on the mesh itself; take "
        "more steps, or use Extrapolate, whose summary describes each step");
  }
  return result.path.Placed(result.path.NumShapes() - 1);
}

Tangent Logarithm(const std::shared_ptr<const Metric>& metric, const Shape& from, const Shape& to,
                  const LogarithmOptions& options, Progress* progress) {
  const FeatureMap refuses_rigid_metrics(metric);  // to fail before the solve, not after it
  GeodesicResult geodesic = Interpolate(metric, {from, to}, options, progress);
  if (geodesic.summary.termination == Termination::kCancelled) throw Cancelled();
  if (geodesic.summary.termination != Termination::kConverged) {
    throw SolverError(
        "the logarithm is not exact: the path between the shapes did not converge; raise "
        "max_iterations or the tolerance");
  }
  Path& path = geodesic.path;
  path.motions.assign(path.NumShapes(), path.motions[0]);  // `to`, aligned with `from`
  return InitialVelocity(path);
}

Tangent InitialVelocity(const Path& path) {
  if (path.NumShapes() < 2) throw MeshError("a path needs at least two shapes to have a direction");
  const std::shared_ptr<const Metric> metric =
      internal::WithCostOfPosition(path.metric, internal::kFreeBodyLambda);
  const RigidMotion &first = path.motions[0], &second = path.motions[1];
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(second.rotation * first.rotation.transpose()));
  const Eigen::Vector3d spin = turn.angle() * turn.axis();
  const Shape arms = metric->unit * (first.rotation * path.shapes[0]);
  internal::MetricSolver solver;
  Tangent way =
      metric->unit * (first.rotation * internal::SegmentVelocity(FeatureMap(metric), path.shapes[1],
                                                                 path.shapes[0], -1, &solver));
  for (int v = 0; v < way.cols(); ++v) {
    way.col(v) += spin.cross(arms.col(v)) + second.translation - first.translation;
  }
  way /= path.parameters[1] - path.parameters[0];
  metric->connectivity->CopyToTwins(&way);
  return way;
}

}  // namespace shapespace
