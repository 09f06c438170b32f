#include <shapespace/correspondence/detail/map_doubt.h>

#include <algorithm>

#include <shapespace/base/parallel.h>
#include <shapespace/correspondence/detail/closest.h>
#include <shapespace/mesh/internal/sides.h>

namespace shapespace::internal {
namespace {

// Two maps send a vertex to different places if these are farther apart than this share of the root
// of the area, and are different ones if they do so with this share of the vertices.
constexpr double kApart = 0.1, kOtherShare = 0.1;
// Smaller parts are not worth a word: ears, fingers.
constexpr double kPartShare = 0.01;
// A vertex of the template is where a part is if the image of a vertex of the part is so near.
constexpr double kCoveredBy = 0.05;

// How far apart two fits send a vertex of the template, if both do.
double Apart(const Shape& target, const CandidateFit& a, const CandidateFit& b, int v) {
  if (a.to_target[v] < 0 || b.to_target[v] < 0) return 0;
  return (target.col(a.to_target[v]) - target.col(b.to_target[v])).norm();
}

}  // namespace

MapDoubt::MapDoubt(const FitBody& coarse_template, const Shape& target,
                   const std::vector<CandidateFit>& fits) {
  const int count = coarse_template.connectivity->NumVertices();
  std::vector<size_t> other(count, 0);  // the first such fit of each vertex
  for (size_t i = 1; i < fits.size() && fits[i].Cost() < kDoubt * fits[0].Cost(); ++i) {
    for (int v = 0; v < count; ++v) {
      if (other[v] == 0 && Apart(target, fits[i], fits[0], v) > kApart) other[v] = i;
    }
  }
  UnionFind connected(count);
  for (const auto& triangle : coarse_template.connectivity->Triangles().colwise()) {
    for (int k = 0; k < 3; ++k) {
      const int v = triangle(k), w = triangle((k + 1) % 3);
      if (other[v] != 0 && other[v] == other[w]) connected.Join(v, w);
    }
  }
  const Eigen::VectorXd areas = VertexAreas(*coarse_template.connectivity, coarse_template.own);
  std::vector<CorrespondenceSummary::PartInDoubt> all(count);
  std::vector<double> farthest(count, 0);
  for (int v = 0; v < count; ++v) {
    if (other[v] == 0) continue;
    const int root = connected.Find(v);
    CorrespondenceSummary::PartInDoubt& part = all[root];
    const CandidateFit& fit = fits[other[v]];
    part.share = (part.vertex < 0 ? 0 : part.share) + areas(v);
    const double apart = Apart(target, fit, fits[0], v);
    if (apart <= farthest[root]) continue;
    farthest[root] = apart;
    part.cost = fit.Cost() / fits[0].Cost();
    part.vertex = v;
    part.target_vertex = fits[0].to_target[v];
    part.other_vertex = fit.to_target[v];
  }
  std::vector<int> roots;
  for (int v = 0; v < count; ++v) {
    if (all[v].share >= kPartShare) roots.push_back(v);
  }
  std::stable_sort(roots.begin(), roots.end(),
                   [&](int a, int b) { return all[a].share > all[b].share; });
  std::vector<int> index(count, -1);
  for (const int root : roots) {
    index[root] = static_cast<int>(parts.size());
    parts.push_back(all[root]);
  }
  for (int v = 0; v < count; ++v) part_of.push_back(other[v] == 0 ? -1 : index[connected.Find(v)]);
}

double Certainty(const Shape& target, const std::vector<CandidateFit>& fits) {
  for (size_t i = 1; i < fits.size(); ++i) {
    const auto count = static_cast<int>(fits[0].to_target.size());
    int apart = 0;
    for (int v = 0; v < count; ++v) apart += Apart(target, fits[i], fits[0], v) > kApart ? 1 : 0;
    if (apart >= kOtherShare * count) return fits[i].Cost() / fits[0].Cost();
  }
  return kNotComputed;
}

std::vector<int> InverseOf(const Shape& on_template, const std::vector<int>& vertices,
                           const std::vector<int>& images) {
  const Shape places = on_template(Eigen::all, images);
  std::vector<int> inverse(vertices.size());
  ParallelFor(static_cast<int>(vertices.size()), [&](int i) {
    Eigen::Index nearest;
    const double squared = (places.colwise() - on_template.col(vertices[i]))
                               .colwise()
                               .squaredNorm()
                               .minCoeff(&nearest);
    inverse[i] = squared < kCoveredBy * kCoveredBy ? static_cast<int>(nearest) : -1;
  });
  return inverse;
}

}  // namespace shapespace::internal
