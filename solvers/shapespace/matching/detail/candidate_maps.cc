#include <shapespace/matching/detail/candidate_maps.h>

#include <algorithm>
#include <utility>

#include <shapespace/base/parallel.h>
#include <shapespace/matching/detail/nearest_columns.h>

namespace shapespace::internal {
namespace {

// Vertices that determine a map, and those that do in its refinement, of MatchingBody::spread.
constexpr int kMapSamples = 400, kRefinedSamples = 1000;
// Numbers of functions. From 10 on instead of 16, ZoomOut loses what is front and back; beyond 60
// it gains nothing that a fit does not.
const std::vector<int> kCoarse = {16, 22, 28, 34, 40}, kFine = {45, 50, 55, 60};
const std::vector<int> kRefined = {40, 50, 60, 70, 80, 90, 100};
// Maps that differ less are the same: mean over samples of the greatest difference between their
// images' distances from any place.
constexpr float kSame = 0.05F;

// Those of the counts that both bodies have; at least one.
std::vector<int> Possible(const std::vector<int>& counts, const MatchingBody& a,
                          const MatchingBody& b) {
  const int most = std::min(a.spectrum.Count(), b.spectrum.Count());
  std::vector<int> possible;
  for (const int count : counts) possible.push_back(std::min(count, most));
  possible.erase(std::unique(possible.begin(), possible.end()), possible.end());
  return possible;
}

std::vector<int> AllCounts(std::vector<int> first, const std::vector<int>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

// The map by descriptors of landmarks.
SpectralMap StartMap(const Landmarks& template_landmarks, int template_extremities,
                     const Landmarks& target_landmarks, int target_extremities,
                     const Assignment& assignment) {
  std::vector<int> first, second;
  for (const auto& [a, b] : assignment.pairs) {
    first.push_back(a);
    second.push_back(b);
  }
  const int known = static_cast<int>(template_landmarks.Vertices().size()) - template_extremities;
  for (int k = 0; k < known; ++k) {
    first.push_back(template_extremities + k);
    second.push_back(target_extremities + k);
  }
  const Eigen::MatrixXf a = template_landmarks.Describe(first),
                        b = target_landmarks.Describe(second);
  SpectralMap map;
  map.to_target = NearestColumns(a.leftCols(std::min<Eigen::Index>(kMapSamples, a.cols())), b);
  map.to_template = NearestColumns(b.leftCols(std::min<Eigen::Index>(kMapSamples, b.cols())), a);
  return map;
}

// Distances of the images of samples from even samples of the target, a column for each image.
Eigen::MatrixXf ImageDistances(const MatchingBody& on_target, const SpectralMap& map) {
  Eigen::MatrixXf distances(on_target.even.distances.cols(), map.to_target.size());
  for (size_t i = 0; i < map.to_target.size(); ++i) {
    distances.col(i) = on_target.even.distances.row(on_target.spread[map.to_target[i]]).transpose();
  }
  return distances;
}

void RemoveRepeated(const MatchingBody& on_target, std::vector<CandidateMap>* maps) {
  std::vector<Eigen::MatrixXf> images;
  std::vector<CandidateMap> different;
  for (CandidateMap& candidate : *maps) {
    Eigen::MatrixXf own = ImageDistances(on_target, candidate.map);
    const bool repeated = std::any_of(images.begin(), images.end(), [&](const auto& earlier) {
      return (earlier - own).cwiseAbs().colwise().maxCoeff().mean() < kSame;
    });
    if (repeated) continue;
    images.push_back(std::move(own));
    different.push_back(std::move(candidate));
  }
  *maps = std::move(different);
}

void ZoomOutAll(const SpectralPoints& on_template, const SpectralPoints& on_target,
                const std::vector<int>& counts, std::vector<CandidateMap>* maps) {
  ParallelFor(static_cast<int>(maps->size()), [&](int i) {
    for (const int count : counts) ZoomOut(on_template, on_target, count, &(*maps)[i].map);
  });
}

// The vertices of `spread`, and then all others.
std::vector<int> SpreadFirst(const MatchingBody& body) {
  std::vector<int> vertices = body.spread;
  std::vector<bool> has(body.surface.NumVertices(), false);
  for (const int v : vertices) has[v] = true;
  for (int v = 0; v < body.surface.NumVertices(); ++v) {
    if (!has[v]) vertices.push_back(v);
  }
  return vertices;
}

// The map of the first vertices in `from`, as indices into `to`.
std::vector<int> Reindexed(const std::vector<int>& map, const std::vector<int>& from, int count,
                           const std::vector<int>& to) {
  std::vector<int> index(to.size());
  for (size_t i = 0; i < to.size(); ++i) index[to[i]] = static_cast<int>(i);
  std::vector<int> result;
  for (int i = 0; i < count; ++i) result.push_back(index[map[from[i]]]);
  return result;
}

}  // namespace

std::vector<CandidateMap> MakeMaps(const MatchingBody& on_template, const MatchingBody& on_target,
                                   const Landmarks& template_landmarks,
                                   const Landmarks& target_landmarks,
                                   const std::vector<Assignment>& assignments, Progress* progress) {
  const std::vector<int> coarse = Possible(kCoarse, on_template, on_target);
  const std::vector<int> fine = Possible(kFine, on_template, on_target);
  const SpectralPoints first(on_template.spectrum, on_template.spread, kMapSamples,
                             AllCounts(coarse, fine));
  const SpectralPoints second(on_target.spectrum, on_target.spread, kMapSamples,
                              AllCounts(coarse, fine));
  std::vector<CandidateMap> maps(assignments.size());
  ReportProgress(progress, "maps of extremities", 0, static_cast<int>(maps.size()));
  ParallelFor(static_cast<int>(maps.size()), [&](int i) {
    maps[i].assignment = assignments[i];
    maps[i].map =
        StartMap(template_landmarks, static_cast<int>(on_template.extremities.size()),
                 target_landmarks, static_cast<int>(on_target.extremities.size()), assignments[i]);
  });
  ZoomOutAll(first, second, coarse, &maps);
  RemoveRepeated(on_target, &maps);
  ReportProgress(progress, "finer maps", 0, static_cast<int>(maps.size()));
  ZoomOutAll(first, second, fine, &maps);
  return maps;
}

SpectralMap RefineMap(const MatchingBody& on_template, const MatchingBody& on_target,
                      const std::vector<int>& to_target, const std::vector<int>& to_template,
                      Progress* progress) {
  const std::vector<int> counts = Possible(kRefined, on_template, on_target);
  const SpectralPoints first(on_template.spectrum, SpreadFirst(on_template), kRefinedSamples,
                             counts);
  const SpectralPoints second(on_target.spectrum, SpreadFirst(on_target), kRefinedSamples, counts);
  SpectralMap map;
  map.to_target = Reindexed(to_target, first.Vertices(), first.NumSamples(), second.Vertices());
  map.to_template =
      Reindexed(to_template, second.Vertices(), second.NumSamples(), first.Vertices());
  for (const int count : counts) {
    ReportProgress(progress, "refined map", count, counts.back());
    ZoomOut(first, second, count, &map);
  }
  return map;
}

}  // namespace shapespace::internal
