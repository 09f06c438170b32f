#include <shapespace/matching/detail/extremities.h>

#include <algorithm>
#include <numeric>

namespace shapespace::internal {
namespace {

// Measured persistences: heads, hands and feet of people 0.14 to 0.65; legs, tails and heads of
// animals 0.17 to 0.63; snouts beside long ears, and ears beside a snout, 0.058 to 0.1; fingers and
// toes 0.02 to 0.051.
constexpr double kPrincipal = 0.1, kMinor = 0.055;
// The number of assignments is exponential in that of extremities.
constexpr size_t kMostPrincipal = 9;
// Fewer determine no map, so that less persistent ones are taken as well.
constexpr size_t kFewestPrincipal = 3;

// Per vertex, the mean distance from the surface.
Eigen::VectorXd MeanSurfaceDistance(const EvenSamples& samples, const Eigen::VectorXd& areas) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(samples.distances.cols());
  for (int v = 0; v < areas.size(); ++v) {
    Eigen::Index nearest;
    samples.distances.row(v).minCoeff(&nearest);
    weights(nearest) += areas(v);
  }
  return samples.distances.cast<double>() * weights / weights.sum();
}

// Sets of vertices around maxima, which grow while the level falls and are joined at saddles.
class Peaks {
 public:
  explicit Peaks(int size) : parent_(size, -1), persistence_(size, 0) {}

  bool Has(int v) const { return parent_[v] >= 0; }
  void Add(int v, int root) { parent_[v] = root; }
  // The maximum of the set to which v belongs.
  int Find(int v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void Join(int lower, int higher, double persistence) {
    parent_[lower] = higher;
    persistence_[lower] = persistence;
  }
  const std::vector<double>& Persistence() const { return persistence_; }

 private:
  std::vector<int> parent_;
  std::vector<double> persistence_;
};

}  // namespace

std::vector<Extremity> FindExtremities(const SurfaceGraph& graph, const EvenSamples& samples,
                                       const Eigen::VectorXd& areas, double least) {
  const Eigen::VectorXd height = MeanSurfaceDistance(samples, areas);
  std::vector<int> order(height.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int v, int w) { return height(v) > height(w); });
  Peaks peaks(static_cast<int>(height.size()));
  for (const int v : order) {
    int highest = -1;
    graph.ForNeighbours(v, [&](int w) {
      if (!peaks.Has(w)) return;
      const int peak = peaks.Find(w);
      if (highest < 0 || peak == highest) {
        highest = peak;
        return;
      }
      const bool higher = height(peak) > height(highest);
      const int lower = higher ? highest : peak;
      highest = higher ? peak : highest;
      peaks.Join(lower, highest, height(lower) - height(v));
    });
    peaks.Add(v, highest < 0 ? v : highest);
  }
  std::vector<double> persistence = peaks.Persistence();
  persistence[order.front()] = height.maxCoeff() - height.minCoeff();
  std::vector<Extremity> extremities;
  for (const int v : order) {
    if (persistence[v] > least) extremities.push_back({v, persistence[v]});
  }
  std::stable_sort(
      extremities.begin(), extremities.end(),
      [](const Extremity& a, const Extremity& b) { return a.persistence > b.persistence; });
  return extremities;
}

std::vector<int> PrincipalExtremities(const std::vector<Extremity>& extremities) {
  std::vector<int> vertices;
  for (const Extremity& extremity : extremities) {
    const bool taken = extremity.persistence > kPrincipal || vertices.size() < kFewestPrincipal;
    if (taken && vertices.size() < kMostPrincipal) vertices.push_back(extremity.vertex);
  }
  return vertices;
}

std::vector<int> MinorExtremities(const std::vector<Extremity>& extremities) {
  std::vector<int> vertices;
  for (size_t i = PrincipalExtremities(extremities).size(); i < extremities.size(); ++i) {
    if (extremities[i].persistence > kMinor) vertices.push_back(extremities[i].vertex);
  }
  return vertices;
}

}  // namespace shapespace::internal
