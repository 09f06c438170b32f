#include <shapespace/deformation/repair.h>

#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/deformation/detail/count_intersections.h>
#include <shapespace/deformation/detail/volume_text.h>
#include <shapespace/deformation/internal/summary_fields.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
namespace {

std::string ErrorText(const ShapeError& error) {
  return internal::Format("edges off by %.3g%% rms, %.3g%% at most; ", 100 * error.edge_rms,
                          100 * error.edge_max) +
         internal::VolumeText(error) +
         internal::Format("; %d hinges turned over", error.inverted_hinges);
}

}  // namespace

std::string RepairSummary::BriefReport() const {
  return internal::Format("%s: %d vertices, moved by %.3g rms; ",
                          internal::Name(deformation.termination), deformation.vertices, moved) +
         "before: " + ErrorText(before) + "; after: " + ErrorText(after) +
         internal::Format("; %.2f s", deformation.total_seconds);
}

std::string RepairSummary::FullReport() const {
  std::ostringstream out;
  out << "Before            " << ErrorText(before) << "\nAfter             " << ErrorText(after)
      << internal::Format("\nMoved             %.6g rms\n", moved) << deformation.FullReport();
  return out.str();
}

std::string RepairSummary::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

RepairResult Repair(const std::shared_ptr<const Connectivity>& connectivity, const Shape& reference,
                    const Shape& distorted, const RepairOptions& options, Progress* progress) {
  options.deformation.Validate();
  const auto metric =
      FreezeMetric(MetricOptions::Isometric(), connectivity, {reference, distorted});
  const Shape placed = FitRigidMotion(reference, distorted, metric->vertex_area)(reference);
  DeformationHandle pose;
  pose.name = "distorted shape";
  pose.vertices = options.vertices;
  if (pose.vertices.empty()) {
    pose.vertices.resize(connectivity->NumVertices());
    std::iota(pose.vertices.begin(), pose.vertices.end(), 0);
  }
  for (int v : pose.vertices) {
    if (v < 0 || v >= connectivity->NumVertices()) {
      throw InvalidOptions("vertices", "" + std::to_string(v) + " is not in 0 .. " +
                                           std::to_string(connectivity->NumVertices() - 1));
    }
  }
  pose.positions = distorted(Eigen::all, pose.vertices);
  pose.hard = false;

  DeformationResult deformed =
      Deformer(connectivity, placed, options.deformation).DeformFrom(distorted, {pose}, progress);
  internal::CountIntersectionsOf(&deformed);
  RepairResult result;
  result.path = std::move(deformed.path);
  RepairSummary& summary = result.summary;
  summary.deformation = std::move(deformed.summary);
  const Shape repaired = result.path.Placed(result.path.NumShapes() - 1);
  summary.before = CompareShapes(result.path.metric, placed, distorted);
  summary.after = CompareShapes(result.path.metric, placed, repaired);
  const Eigen::VectorXd& area = metric->vertex_area;
  summary.moved = std::sqrt((repaired - distorted).colwise().squaredNorm().dot(area) / area.sum());
  return result;
}

}  // namespace shapespace
