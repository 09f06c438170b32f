#include <shapespace/correspondence/correspondence.h>

#include <optional>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/correspondence/detail/check_input.h>
#include <shapespace/correspondence/detail/fit_map.h>
#include <shapespace/correspondence/detail/found_markers.h>
#include <shapespace/correspondence/detail/gradient_fit.h>
#include <shapespace/correspondence/detail/marker_fit.h>
#include <shapespace/correspondence/detail/memory.h>
#include <shapespace/correspondence/detail/own_frame.h>
#include <shapespace/matching/internal/check_body.h>
#include <shapespace/mesh/volume.h>
#include <shapespace/summary/internal/check_options.h>
#include <shapespace/summary/internal/memory.h>

namespace shapespace {
namespace {

// Markers on vertices that have elements; vertices that do not exist remain for the check.
std::vector<CorrespondenceMarker> MarkersOnRepresentatives(
    std::vector<CorrespondenceMarker> markers, const Connectivity& template_connectivity,
    const Connectivity& target_connectivity) {
  const auto represent = [](const Connectivity& connectivity, int* v) {
    if (*v >= 0 && *v < connectivity.NumVertices()) *v = connectivity.Representative(*v);
  };
  for (CorrespondenceMarker& marker : markers) {
    represent(template_connectivity, &marker.template_vertex);
    represent(target_connectivity, &marker.target_vertex);
  }
  return markers;
}

// Checks the arguments of `Correspond`, and says in the summary how large they are.
void CheckInput(const Connectivity& template_connectivity, const Shape& template_shape,
                const Connectivity& target_connectivity, const Shape& target_shape,
                const std::vector<CorrespondenceMarker>& markers,
                const CorrespondenceOptions& options, CorrespondenceSummary* summary) {
  options.Validate();
  internal::CheckBody("template", template_connectivity, template_shape);
  internal::CheckBody("target", target_connectivity, target_shape);
  summary->estimated_bytes = internal::CorrespondenceBytes(
      template_connectivity, target_connectivity, static_cast<int>(markers.size()));
  internal::CheckMemory("this fit", summary->estimated_bytes, options.memory_limit,
                        "use meshes of fewer vertices");
  summary->template_vertices = template_connectivity.NumVertices();
  summary->template_triangles = template_connectivity.NumTriangles();
  summary->target_vertices = target_connectivity.NumVertices();
  summary->target_triangles = target_connectivity.NumTriangles();
}

}  // namespace

void CorrespondenceOptions::Validate() const {
  if (!(proportions > 0) || !(proportions <= 10)) {
    throw InvalidOptions("proportions", "must be above 0 and at most 10");
  }
  if (!(bending >= 0) || !(bending <= 1e6)) {
    throw InvalidOptions("bending", "must be from 0 to 1e6");
  }
  internal::CheckTolerance(tolerance);
  internal::CheckMaxIterations(max_iterations);
  if (coarsest < 1) throw InvalidOptions("coarsest", "must be 1 or more");
  internal::CheckMemoryLimit(memory_limit);
}

CorrespondenceResult Correspond(const std::shared_ptr<const Connectivity>& template_mesh,
                                const Shape& template_shape,
                                const std::shared_ptr<const Connectivity>& target_mesh,
                                const Shape& target_shape,
                                const std::vector<CorrespondenceMarker>& given_markers,
                                const CorrespondenceOptions& options, Progress* progress) {
  const internal::Stopwatch total;
  const std::vector<CorrespondenceMarker> markers =
      MarkersOnRepresentatives(given_markers, *template_mesh, *target_mesh);
  CorrespondenceSummary summary;
  CheckInput(*template_mesh, template_shape, *target_mesh, target_shape, markers, options,
             &summary);
  const internal::FitBody from(template_mesh, template_shape), target(target_mesh, target_shape);
  CorrespondenceResult result =
      options.find_markers || markers.size() < 3
          ? internal::FitWithFoundMarkers(from, target, markers, options, summary, progress)
          : internal::FitWithMarkers(from, target, markers, markers.size(), options, summary,
                                     internal::Effort::kUnfold, progress);
  result.summary.total_seconds = total.Seconds();
  return result;
}

Path CarryPath(const CorrespondenceResult& result, const Path& path,
               const std::shared_ptr<const Connectivity>& target_connectivity,
               const Shape& target_shape) {
  path.Validate();
  const int num_vertices = target_connectivity->NumVertices();
  if (target_shape.cols() != num_vertices || result.map.gap.size() != num_vertices) {
    throw MeshError("the target has " + std::to_string(num_vertices) + " vertices, its shape " +
                    std::to_string(target_shape.cols()) + ", and the map's target " +
                    std::to_string(result.map.gap.size()));
  }
  const internal::OwnFrame frame(*target_connectivity, target_shape);
  std::vector<int> covered;
  for (int y = 0; y < result.map.gap.size(); ++y) {
    if (result.map.gap(y) < internal::kCovered) covered.push_back(y);
  }
  // Where the template has no corresponding part, the target moves as its nearest covered part.
  std::optional<internal::GradientFit> fit;
  if (static_cast<int>(covered.size()) < num_vertices) {
    fit.emplace(*target_connectivity, frame.In(target_shape), covered, 0);
  }
  std::vector<Shape> carried;
  for (int i = 0; i < path.NumShapes(); ++i) {
    carried.push_back(CarryAlong(result.map.to_template, *path.metric->connectivity, result.fitted,
                                 path.Placed(i), target_shape));
    if (!fit) continue;
    const Shape places = frame.In(carried.back())(Eigen::all, covered);
    carried.back() = frame.Out((*fit)(places));
  }
  MetricOptions options = path.metric->options;
  if (!EnclosesVolume(target_connectivity->Triangles(), target_shape)) options.volume = 0;
  for (Eigen::VectorXd* field : {&options.stretching_stiffness, &options.bending_stiffness}) {
    if (field->size() == 0) continue;
    const Eigen::VectorXd of_vertices =
        VertexStiffness(*field, options.stiffness_on, *path.metric->connectivity);
    *field = PullBack(result.map.to_template, path.metric->connectivity->Triangles(),
                      of_vertices.transpose())
                 .transpose();
  }
  options.stiffness_on = StiffnessOn::kVertices;
  Path own =
      MakePath(FreezeMetric(options, target_connectivity, carried), carried, path.parameters);
  own.poses = path.poses;
  own.pose_names = path.pose_names;
  own.extrapolated = path.extrapolated;
  own.converged = path.converged && result.summary.Converged();
  own.provenance = path.provenance;
  return own;
}

}  // namespace shapespace
