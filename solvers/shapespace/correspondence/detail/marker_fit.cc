#include <shapespace/correspondence/detail/marker_fit.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/correspondence/detail/check_input.h>
#include <shapespace/correspondence/detail/fit_map.h>
#include <shapespace/correspondence/detail/marked_part.h>
#include <shapespace/correspondence/detail/marker_check.h>
#include <shapespace/correspondence/detail/marker_distances.h>
#include <shapespace/correspondence/detail/similarity.h>
#include <shapespace/matching/internal/check_body.h>
#include <shapespace/mesh/ties.h>

namespace shapespace::internal {
namespace {

// Ratio of the bodies' sizes: the median ratio of the distances between markers along the surface,
// which do not depend on poses or holes.
double RelativeSize(const Eigen::MatrixXf& on_template, const Eigen::MatrixXf& on_target,
                    const std::vector<int>& template_vertices,
                    const std::vector<int>& target_vertices) {
  std::vector<double> ratios;
  for (size_t k = 0; k < template_vertices.size(); ++k) {
    for (size_t l = 0; l < k; ++l) {
      const auto column = static_cast<Eigen::Index>(l);
      const double ratio =
          on_target(target_vertices[k], column) / on_template(template_vertices[k], column);
      if (std::isfinite(ratio) && ratio > 0) ratios.push_back(ratio);
    }
  }
  if (ratios.empty()) return 1;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

// What the distances between markers along both surfaces say.
struct MeasuredMarkers {
  std::vector<CorrespondenceSummary::Doubt> doubtful;
  double size;  // of the target relative to the template
  MarkerDistances distances;
};

// `rest` and `goal`: template and target, each in its own frame.
MeasuredMarkers Measure(const std::vector<CorrespondenceMarker>& markers,
                        const Connectivity& template_connectivity, const Shape& rest,
                        const Connectivity& target_connectivity, const Shape& goal) {
  std::vector<int> on_template, on_target;
  for (const CorrespondenceMarker& marker : markers) {
    on_template.push_back(marker.template_vertex);
    on_target.push_back(marker.target_vertex);
  }
  Eigen::MatrixXf first = DistancesFrom(template_connectivity, rest, on_template);
  Eigen::MatrixXf second = DistancesFrom(target_connectivity, goal, on_target);
  const double size = RelativeSize(first, second, on_template, on_target);
  first *= static_cast<float>(size);
  return {FindDoubtfulMarkers(first, second, on_template, on_target), size,
          MarkerDistances(std::move(first), std::move(second))};
}

std::string Percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, share < 0.1 ? "%.2g %%" : "%.0f %%", 100 * share);
  return text;
}

void Warn(const CorrespondenceOptions& options, const std::vector<CorrespondenceMarker>& markers,
          CorrespondenceSummary* summary) {
  for (const auto& doubt : summary->doubtful) {
    const CorrespondenceMarker& marker = markers[doubt.marker];
    std::string text = "marker " + std::to_string(doubt.marker + 1) + " (vertices " +
                       std::to_string(marker.template_vertex + 1) + " and " +
                       std::to_string(marker.target_vertex + 1) + ") contradicts the others";
    if (doubt.swapped >= 0) {
      text += "; it seems to be exchanged with marker " + std::to_string(doubt.swapped + 1);
    } else {
      text += "; they predict it near the target's vertex " + std::to_string(doubt.expected + 1);
    }
    summary->warnings.push_back(text +
                                (options.drop_doubtful ? ", and was ignored" : ", but was used"));
  }
  if (summary->cancelled) summary->warnings.push_back("cancelled: the fit ended early");
  if (!summary->converged && !summary->cancelled) {
    summary->warnings.push_back("the final rounds did not converge: check the picture");
  }
  constexpr double kWorthATurn = 2e-3, kWorthAHole = 0.02;
  if (summary->turned > kWorthATurn) {
    summary->warnings.push_back(Percent(summary->turned) +
                                " of the triangles have normals opposite to the target's: check "
                                "there for detail that only one of the bodies has");
  }
  if (summary->uncovered > kWorthAHole) {
    summary->warnings.push_back(Percent(summary->uncovered) +
                                " of the target's area is not near any part of the template: a "
                                "marker may be missing there");
  }
}

std::string ToldOfOthers(const FitBody& body, const MarkedPart& part) {
  const double share = VertexAreas(*body.connectivity, body.own)(part.vertices).sum();
  return std::to_string(part.others) + (part.others == 1 ? " component" : " components") +
         " of the template without a marker, " + Percent(1 - share) +
         " of its area, follow what is nearest to them";
}

}  // namespace

FitBody::FitBody(const std::shared_ptr<const Connectivity>& mesh, const Shape& the_shape)
    : connectivity(WithoutStiffeners(mesh)),
      shape(the_shape),
      frame(*connectivity, shape),
      own(frame.In(shape)) {}

CorrespondenceResult FitWithMarkers(const FitBody& from, const FitBody& target,
                                    const std::vector<CorrespondenceMarker>& all_markers,
                                    size_t num_given, const CorrespondenceOptions& options,
                                    const CorrespondenceSummary& begun, Effort effort,
                                    Progress* progress) {
  const Stopwatch stopwatch;
  CorrespondenceResult result;
  CorrespondenceSummary& summary = result.summary;
  summary = begun;
  CheckMarkers(all_markers, *from.connectivity, *target.connectivity);
  ReportProgress(progress, "checking markers", 0, 0);
  std::vector<CorrespondenceMarker> markers = all_markers;
  const auto measure = [&] {
    return Measure(markers, *from.connectivity, from.own, *target.connectivity, target.own);
  };
  MeasuredMarkers measured = measure();
  summary.doubtful = measured.doubtful;
  if (options.drop_doubtful && !summary.doubtful.empty()) {
    markers = Without(all_markers, summary.doubtful);
    CheckMarkers(markers, *from.connectivity, *target.connectivity);
    measured = measure();
  }
  std::vector<CorrespondenceSummary::Doubt>& doubtful = summary.doubtful;
  doubtful.erase(std::remove_if(doubtful.begin(), doubtful.end(),
                                [&](const CorrespondenceSummary::Doubt& doubt) {
                                  return doubt.marker >= static_cast<int>(num_given);
                                }),
                 doubtful.end());
  const double size = measured.size;
  summary.markers = static_cast<int>(markers.size());
  summary.scale = size * target.frame.unit / from.frame.unit;
  CheckHandedness(*from.connectivity, from.own, *target.connectivity, target.own, markers,
                  measured.distances.OnTemplate());

  // In ascending order of the template's vertices, which is their order in the levels.
  std::sort(markers.begin(), markers.end(),
            [](const CorrespondenceMarker& a, const CorrespondenceMarker& b) {
              return a.template_vertex < b.template_vertex;
            });
  result.markers = markers;
  FitMarkers placed;
  std::vector<CorrespondenceMarker> held;
  std::vector<int> images;
  for (const CorrespondenceMarker& marker : markers) {
    placed.vertices.push_back(marker.template_vertex);
    placed.held.push_back(!marker.soft);
    images.push_back(marker.target_vertex);
    if (!marker.soft) held.push_back(marker);
  }
  const MarkedPart part(from.connectivity, markers);
  const Shape ends = from.own(Eigen::all, placed.vertices);
  for (int& v : placed.vertices) v = part.IndexOf(v);
  placed.positions = target.own(Eigen::all, images);
  CheckPlacement(ends, placed.positions);
  const Shape rest = MovedOnto(size * ends, placed.positions, size * from.own);
  const Target goal(target.connectivity, target.own, measured.distances);
  summary.marker_seconds = stopwatch.Seconds();

  TemplateFit fit(options, goal, std::move(placed), effort, progress, &summary);
  const Shape fitted_part = fit(part.connectivity, rest(Eigen::all, part.vertices));
  if (!HasArea(*part.connectivity, fitted_part)) {
    throw MeshError(
        "the markers leave no area of the template: some that are apart on the template lie at one "
        "place of the target, or on one line");
  }

  const Stopwatch map_stopwatch;
  const Shape fitted = part.Follow(rest, fitted_part);
  if (!part.IsAll()) summary.warnings.push_back(ToldOfOthers(from, part));
  Level all = {from.connectivity, {}, BorderOf(*from.connectivity)};
  for (int v = 0; v < from.connectivity->NumVertices(); ++v) all.vertices.push_back(v);
  result.map = MakeMap(all, fitted, rest / size, goal, held, &summary);
  result.fitted = target.frame.Out(fitted);
  for (const CorrespondenceMarker& marker : held) {
    result.fitted.col(marker.template_vertex) = target.shape.col(marker.target_vertex);
  }
  from.connectivity->CopyToTwins(&result.fitted);
  summary.map_seconds = map_stopwatch.Seconds();
  WarnOfTopology(*from.connectivity, *target.connectivity, markers, &summary.warnings);
  Warn(options, all_markers, &summary);
  return result;
}

}  // namespace shapespace::internal
