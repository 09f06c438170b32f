#include <shapespace/solvers/transfer.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include <shapespace/base/error.h>
#include <shapespace/base/stopwatch.h>
#include <shapespace/path/rigid_motion.h>
#include <shapespace/solvers/report.h>

namespace shapespace {
namespace {

// Root mean square distance of the surface from its centroid.
double Radius(const Shape& shape, const Eigen::VectorXd& weights) {
  const Eigen::Vector3d centre = Centroid(shape, weights);
  const Eigen::VectorXd squares = (shape.colwise() - centre).colwise().squaredNorm().transpose();
  return std::sqrt(squares.dot(weights) / weights.sum());
}

Path TwoShapes(const std::shared_ptr<const Metric>& metric, const Shape& from, const Shape& to) {
  Path path;
  path.metric = metric;
  path.shapes = {from / metric->unit, to / metric->unit};
  path.parameters = {0, 1};
  path.motions.resize(2);
  path.poses = {0, 1};
  return path;
}

// A path of the target, or half way to it: shapes in the source's aligned frame and the target's
// size, which `motions` put into place.
Path MakePath(const Path& source, const std::shared_ptr<const Metric>& metric,
              std::vector<Shape> shapes, const std::vector<RigidMotion>& motions,
              const char* what) {
  Path path;
  path.metric = metric;
  for (Shape& shape : shapes) path.shapes.push_back(shape / metric->unit);
  path.parameters = source.parameters;
  path.motions = motions;
  path.poses = source.poses;
  path.extrapolated = source.extrapolated;
  path.provenance = source.provenance + what;
  return path;
}

void MeasureStrains(const Metric& metric, const Path& source, const Path& target,
                    TransferSummary* summary) {
  const Eigen::Matrix2Xi& edges = metric.connectivity->Edges();
  double squares = 0, area = 0;
  for (int e = 0; e < edges.cols(); ++e) {
    const auto strain = [&](const Path& path) {
      const auto length = [&](const Shape& shape) {
        return (shape.col(edges(1, e)) - shape.col(edges(0, e))).norm();
      };
      return std::log(length(path.shapes.back()) / length(path.shapes.front()));
    };
    const double off = std::abs(strain(target) - strain(source));
    if (!std::isfinite(off)) continue;  // an edge without length
    squares += metric.edge_area(e) * off * off;
    area += metric.edge_area(e);
    summary->strain_max = std::max(summary->strain_max, off);
  }
  if (area > 0) summary->strain_rms = std::sqrt(squares / area);
}

}  // namespace

MetricOptions TransferOptions::Strains() {
  MetricOptions metric;
  metric.isometric = 0;
  metric.log_length = 1;
  metric.bending = 0.03;
  return metric;
}

void TransferOptions::Validate() const {
  metric.Validate();
  if (metric.rigid > 0) {
    throw InvalidOptions("metric.rigid: the rigid metric knows no parallel transport; use 0");
  }
  if (rung_shapes < 1 || rung_shapes % 2 == 0) {
    throw InvalidOptions("rung_shapes: must be odd, 1 or more");
  }
  if (!(tolerance > 0) || !(tolerance < 1)) {
    throw InvalidOptions("tolerance: must be between 0 and 1");
  }
}

bool TransferSummary::Converged() const {
  return std::all_of(rungs.begin(), rungs.end(), [](const Rung& rung) { return rung.converged; });
}

std::string TransferSummary::BriefReport() const {
  return internal::Format(
      "%s: %d vertices, %zu rungs; target %.4g times as large; strains off by %.3g rms; %.2f s",
      Converged() ? "converged" : "NOT CONVERGED", vertices, rungs.size(), scale, strain_rms,
      total_seconds);
}

std::string TransferSummary::ToJson() const {
  nlohmann::ordered_json json;
  json["converged"] = Converged();
  json["vertices"] = vertices;
  json["metric"] = metric;
  json["scale"] = scale;
  json["rungs"] = nlohmann::ordered_json::array();
  for (const Rung& rung : rungs) {
    json["rungs"].push_back({{"converged", rung.converged},
                             {"on_mesh", rung.on_mesh},
                             {"energy_over_bound", internal::Number(rung.ratio)},
                             {"norm_change", internal::Number(rung.norm_change)},
                             {"seconds", rung.seconds}});
  }
  json["strain"] = {{"rms", strain_rms}, {"max", strain_max}};
  json["seconds"] = total_seconds;
  json["warnings"] = warnings;
  return json.dump(2) + "\n";
}

TransferResult Transfer(const Path& source, const Shape& target, const TransferOptions& options,
                        Progress* progress) {
  options.Validate();
  const Stopwatch total;
  const auto& connectivity = source.metric->connectivity;
  if (target.cols() != connectivity->NumVertices() || !target.allFinite()) {
    throw MeshError("the target is not finite, or has another number of vertices than the source");
  }
  const int count = source.NumShapes();
  if (count < 2) throw MeshError("a source of one shape has no motion to transfer");
  const Eigen::VectorXd& weights = source.metric->vertex_area;
  TransferResult result;
  TransferSummary& summary = result.summary;

  // All happens in the source's aligned frame and the target's size: there the target is `first`,
  // and `motions` lead back to where the source's motion would take it.
  std::vector<Shape> shapes;
  for (const Shape& shape : source.shapes) shapes.push_back(source.metric->unit * shape);
  summary.scale = Radius(target, weights) / Radius(shapes[0], weights);
  if (!(summary.scale > 0) || !std::isfinite(summary.scale)) {
    throw MeshError("the target or the source's first shape has no extent");
  }
  const double size = options.scale ? summary.scale : 1;
  for (Shape& shape : shapes) shape *= size;
  RigidMotion place = FitRigidMotion(shapes[0], target, weights);
  if (!options.align) {
    place.translation += place.rotation * Centroid(shapes[0], weights);
    place.rotation.setIdentity();
  }
  const Shape first = place.rotation.transpose() * (target.colwise() - place.translation);
  std::vector<RigidMotion> motions(count);
  const Eigen::Matrix3d turn = place.rotation * source.motions[0].rotation.transpose();
  for (int i = 0; i < count; ++i) {
    motions[i].rotation = turn * source.motions[i].rotation;
    motions[i].translation =
        place.translation +
        size * turn * (source.motions[i].translation - source.motions[0].translation);
  }

  std::vector<Shape> poses = shapes;
  poses.insert(poses.begin(), first);
  const auto metric =
      std::make_shared<const Metric>(FreezeMetric(options.metric, connectivity, poses));
  summary.vertices = connectivity->NumVertices();
  summary.metric = Describe(options.metric);

  GeodesicOptions geodesic;
  geodesic.shapes = options.rung_shapes;
  geodesic.tolerance = options.tolerance;
  TransportOptions transport;
  transport.connection = options.connection;
  transport.align = options.align;
  ExponentialOptions exponential;
  exponential.tolerance = 1e-12;  // copies come out to ten digits

  std::vector<Shape> targets = {first}, hybrids;
  for (int i = 0; i < count; ++i) {
    ReportProgress(progress, "transferring", i, count);
    const Stopwatch stopwatch;
    TransferSummary::Rung row;
    const Shape& current = targets[i];
    // The shape of the source, and the next, scaled and turned onto the target's.
    const double local = options.scale ? Radius(current, weights) / Radius(shapes[i], weights) : 1;
    RigidMotion onto = FitRigidMotion(local * shapes[i], current, weights);
    if (!options.align) onto = {};
    const Shape from = onto(local * shapes[i]);
    const GeodesicResult rung = Interpolate(metric, {from, current}, geodesic);
    row.ratio = rung.summary.Ratio();
    row.converged = rung.summary.termination == Termination::kConverged;
    hybrids.push_back(rung.path.Placed((options.rung_shapes + 1) / 2));
    if (i + 1 < count) {
      const Tangent velocity =
          InitialVelocity(TwoShapes(metric, from, onto(local * shapes[i + 1])));
      const TransportResult carried = Transport(rung.path, {velocity}, transport);
      const ExponentialResult next =
          Extrapolate(metric, current, carried.tangents[0], 1, exponential);
      if (next.summary.ending != ExponentialSummary::Ending::kComplete) {
        throw SolverError("rung " + std::to_string(i) + ": " + next.summary.stopped);
      }
      const double norm = carried.summary.first_norm[0];
      if (norm > 0) row.norm_change = carried.summary.last_norm[0] / norm - 1;
      row.converged = row.converged && carried.summary.converged;
      row.on_mesh = next.summary.steps[0].vertices == summary.vertices;
      targets.push_back(next.path.Placed(1));
    }
    row.seconds = stopwatch.Seconds();
    summary.rungs.push_back(row);
  }
  result.path = MakePath(source, metric, std::move(targets), motions, "; transferred");
  result.hybrids = MakePath(source, metric, std::move(hybrids), motions, "; hybrids");
  MeasureStrains(*metric, source, result.path, &summary);
  const auto coarse =
      std::count_if(summary.rungs.begin(), summary.rungs.end(),
                    [](const TransferSummary::Rung& rung) { return !rung.on_mesh; });
  if (coarse > 0) {
    summary.warnings.push_back(std::to_string(coarse) + " of " + std::to_string(count - 1) +
                               " steps were made on a coarser mesh, and detail carried along");
  }
  if (!summary.Converged()) {
    summary.warnings.push_back("some rungs did not converge; raise the tolerance");
  }
  summary.total_seconds = total.Seconds();
  return result;
}

}  // namespace shapespace
