#include <shapespace/correspondence/detail/check_input.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/correspondence/detail/similarity.h>
#include <shapespace/mesh/surface.h>
#include <shapespace/mesh/topology.h>
#include <shapespace/mesh/volume.h>

namespace shapespace::internal {
namespace {

std::string MarkerName(size_t marker) { return "marker " + std::to_string(marker + 1); }

std::string Count(int count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// The sine of the angle from vertex b to vertex c around a, seen from outside.
double SineAround(const Shape& shape, const Shape& normals, int a, int b, int c) {
  const Eigen::Vector3d p = shape.col(b) - shape.col(a), q = shape.col(c) - shape.col(a);
  const double lengths = p.norm() * q.norm();
  return lengths > 0 ? normals.col(a).dot(p.cross(q)) / lengths : 0;
}

}  // namespace

void CheckMarkerVertices(const std::vector<CorrespondenceMarker>& markers,
                         const Connectivity& template_connectivity,
                         const Connectivity& target_connectivity) {
  const auto check = [&](const std::string& name, const Connectivity& connectivity,
                         int CorrespondenceMarker::*vertex) {
    std::map<int, size_t> seen;
    for (size_t k = 0; k < markers.size(); ++k) {
      const int v = markers[k].*vertex;
      if (v < 0 || v >= connectivity.NumVertices()) {
        throw MeshError(MarkerName(k) + ": the " + name + " has no vertex " +
                        std::to_string(v + 1) + "; it has " +
                        std::to_string(connectivity.NumVertices()));
      }
      if (connectivity.TrianglesOfVertices()[v].size() == 0) {
        throw MeshError(MarkerName(k) + ": no triangle of the " + name + " uses vertex " +
                        std::to_string(v + 1) + "; name one on the surface");
      }
      const auto [found, is_new] = seen.emplace(v, k);
      if (!is_new) {
        throw MeshError(MarkerName(k) + " and " + MarkerName(found->second) +
                        " are on the same vertex " + std::to_string(v + 1) + " of the " + name +
                        "; leave one of them out");
      }
    }
  };
  check("template", template_connectivity, &CorrespondenceMarker::template_vertex);
  check("target", target_connectivity, &CorrespondenceMarker::target_vertex);
}

void CheckMarkers(const std::vector<CorrespondenceMarker>& markers,
                  const Connectivity& template_connectivity,
                  const Connectivity& target_connectivity) {
  if (markers.size() < 3) {
    throw MeshError(Count(static_cast<int>(markers.size()), "marker") +
                    (markers.size() == 1 ? " is" : " are") +
                    " too few: give at least three that do not lie on a line, better one at the "
                    "end of every limb and a few on the trunk");
  }
  CheckMarkerVertices(markers, template_connectivity, target_connectivity);
}

void CheckPlacement(const Shape& on_template, const Shape& on_target) {
  const auto check = [](const std::string& name, const Shape& points) {
    if (!AreCollinear(points)) return;
    throw MeshError("the markers lie on one line of the " + name +
                    ", so its rotation is not determined; add one beside the line");
  };
  check("template", on_template);
  check("target", on_target);
  // Different poses fit badly with and without reflection; it is a mirror image only if the fit
  // with reflection is good.
  constexpr double kFitsWell = 0.2, kMuchBetter = 0.5;
  const SimilarityErrors errors = CompareReflection(on_template, on_target);
  if (errors.reflected < kFitsWell && errors.reflected < kMuchBetter * errors.proper) {
    throw MeshError(
        "the markers fit a mirror image of the template, not the template: are left and right "
        "exchanged, or is one of the meshes mirrored?");
  }
}

void CheckHandedness(const Connectivity& template_connectivity, const Shape& template_shape,
                     const Connectivity& target_connectivity, const Shape& target_shape,
                     const std::vector<CorrespondenceMarker>& markers,
                     const Eigen::MatrixXf& distances) {
  // The threshold is a hundredth of a ball's volume: the orientation of thinner bodies is not
  // reliable.
  constexpr double kMinVolume = 1e-3;
  const double first = EnclosedVolume(template_connectivity.Triangles(), template_shape);
  const double second = EnclosedVolume(target_connectivity.Triangles(), target_shape);
  if (first * second < 0 && std::min(std::abs(first), std::abs(second)) > kMinVolume &&
      IsClosed(template_connectivity.Triangles()) && IsClosed(target_connectivity.Triangles())) {
    throw MeshError(std::string("the ") + (first < 0 ? "template" : "target") +
                    " is inside out: reverse the vertices of each of its faces; or is it a mirror "
                    "image?");
  }
  // On six real pairs, correct markers have a correlation of .2 to .9, and any twelve of them at
  // least -.2; fewer markers do not suffice for a decision.
  constexpr int kMinMarkers = 12, kNeighbours = 4;
  constexpr double kOpposite = -0.5;
  const auto num_markers = static_cast<int>(markers.size());
  if (num_markers < kMinMarkers) return;
  const Shape template_normals = VertexNormals(template_connectivity, template_shape);
  const Shape target_normals = VertexNormals(target_connectivity, target_shape);
  double both = 0, on_template = 0, on_target = 0;
  for (const CorrespondenceMarker& a : markers) {
    std::vector<int> near(num_markers);
    std::iota(near.begin(), near.end(), 0);
    // The first one is `a` itself.
    std::partial_sort(near.begin(), near.begin() + kNeighbours + 1, near.end(), [&](int k, int l) {
      return distances(a.template_vertex, k) < distances(a.template_vertex, l);
    });
    for (int i = 1; i <= kNeighbours; ++i) {
      for (int j = 1; j < i; ++j) {
        const CorrespondenceMarker& b = markers[near[i]];
        const CorrespondenceMarker& c = markers[near[j]];
        const double from = SineAround(template_shape, template_normals, a.template_vertex,
                                       b.template_vertex, c.template_vertex);
        const double to = SineAround(target_shape, target_normals, a.target_vertex, b.target_vertex,
                                     c.target_vertex);
        both += from * to;
        on_template += from * from;
        on_target += to * to;
      }
    }
  }
  if (both < kOpposite * std::sqrt(on_template * on_target)) {
    throw MeshError(
        "the cyclic order of the markers around each other is reversed on the target, as on a "
        "mirror image: are left and right exchanged, or is one of the meshes mirrored or inside "
        "out?");
  }
}

std::vector<CorrespondenceMarker> Without(
    const std::vector<CorrespondenceMarker>& markers,
    const std::vector<CorrespondenceSummary::Doubt>& doubtful) {
  std::vector<CorrespondenceMarker> kept;
  for (size_t k = 0; k < markers.size(); ++k) {
    const bool is_doubtful = std::any_of(doubtful.begin(), doubtful.end(), [&](const auto& doubt) {
      return doubt.marker == static_cast<int>(k);
    });
    if (!is_doubtful) kept.push_back(markers[k]);
  }
  return kept;
}

void WarnOfTopology(const Connectivity& template_connectivity,
                    const Connectivity& target_connectivity,
                    const std::vector<CorrespondenceMarker>& markers,
                    std::vector<std::string>* warnings) {
  const Topology first = ComputeTopology(template_connectivity);
  const Topology second = ComputeTopology(target_connectivity);
  std::vector<bool> has_marker(second.components, false);
  for (const CorrespondenceMarker& marker : markers)
    has_marker[second.component[marker.target_vertex]] = true;
  const auto without = static_cast<int>(std::count(has_marker.begin(), has_marker.end(), false));
  if (without > 0) {
    warnings->push_back("the target has " + Count(second.components, "component") + ", " +
                        std::to_string(without) +
                        " of them without a marker: nothing is mapped onto those");
  }
  if (!first.manifold || !second.manifold) return;
  if (first.components == second.components && first.genus != second.genus) {
    warnings->push_back("the template's genus is " + std::to_string(first.genus) +
                        ", the target's " + std::to_string(second.genus) +
                        ": the map is wrong around a handle of the surface that only one has");
  }
  if (!second.boundary_loops.empty() &&
      second.boundary_loops.size() != first.boundary_loops.size()) {
    warnings->push_back("the template has " +
                        Count(static_cast<int>(first.boundary_loops.size()), "border") +
                        ", the target " + std::to_string(second.boundary_loops.size()) +
                        ": over a hole the template follows the surface around it");
  }
}

}  // namespace shapespace::internal
