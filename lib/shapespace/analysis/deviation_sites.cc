#include <shapespace/analysis/deviation_sites.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/parallel.h>
#include <shapespace/mesh/internal/sides.h>

namespace shapespace {
namespace {

// Deviations below this are rounding.
constexpr double kNoise = 1e-9;

}  // namespace

std::vector<DeviationSite> FindDeviationSites(const Path& path, const RigidParts& parts) {
  const Metric& metric = *path.metric;
  const Connectivity& connectivity = *metric.connectivity;
  const int num_vertices = connectivity.NumVertices();
  std::vector<Eigen::VectorXd> by_shape(path.NumShapes());
  ParallelFor(path.NumShapes(), [&](int i) { by_shape[i] = EdgeDeviation(path, i); });
  Eigen::VectorXd deviation = Eigen::VectorXd::Zero(num_vertices);
  for (const Eigen::VectorXd& one : by_shape) deviation = deviation.cwiseMax(one);
  deviation(connectivity.Twins()).setZero();  // their representatives count
  const Eigen::VectorXd weight = metric.vertex_area / metric.vertex_area.sum();
  const double total = deviation.cwiseAbs2().dot(weight);
  const double threshold = std::max(std::sqrt(total), kNoise);

  internal::UnionFind sites(num_vertices);
  const auto inside = [&](int v) { return deviation(v) > threshold; };
  const Eigen::Matrix2Xi& edges = connectivity.Edges();
  for (int e = 0; e < edges.cols(); ++e) {
    if (inside(edges(0, e)) && inside(edges(1, e))) sites.Join(edges(0, e), edges(1, e));
  }
  std::vector<DeviationSite> result;
  std::vector<int> index(num_vertices, -1);
  for (int v = 0; v < num_vertices; ++v) {
    if (!inside(v)) continue;
    int& at = index[sites.Find(v)];
    if (at < 0) {
      at = static_cast<int>(result.size());
      result.emplace_back();
    }
    index[v] = at;
    DeviationSite& site = result[at];
    site.share += weight(v) * deviation(v) * deviation(v) / total;
    site.area_share += weight(v);
    if (deviation(v) > site.largest) {
      site.largest = deviation(v);
      site.vertex = v;
    }
  }
  // Numbers of ends of edges at the site, by part.
  std::vector<std::vector<std::pair<int, int>>> touched(result.size());
  for (int e = 0; e < edges.cols(); ++e) {
    const int at = std::max(index[edges(0, e)], index[edges(1, e)]);
    if (at < 0) continue;
    for (int k = 0; k < 2; ++k) {
      const int part = parts.of_vertex(edges(k, e));
      if (part == RigidParts::kJoint) continue;
      auto entry = std::find_if(touched[at].begin(), touched[at].end(),
                                [&](const auto& known) { return known.second == part; });
      if (entry == touched[at].end()) entry = touched[at].insert(entry, {0, part});
      --entry->first;
    }
  }
  const Shape first = path.Placed(0);
  for (size_t at = 0; at < result.size(); ++at) {
    std::sort(touched[at].begin(), touched[at].end());
    for (const auto& known : touched[at]) result[at].parts.push_back(known.second);
    result[at].position = first.col(result[at].vertex);
  }
  std::stable_sort(
      result.begin(), result.end(),
      [](const DeviationSite& a, const DeviationSite& b) { return a.share > b.share; });
  return result;
}

}  // namespace shapespace
