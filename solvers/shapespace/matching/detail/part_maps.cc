#include <shapespace/matching/detail/part_maps.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <shapespace/base/parallel.h>
#include <shapespace/matching/detail/nearest_columns.h>

namespace shapespace::internal {
namespace {

// The target has between this share of the template's area and all of it; as many scales are tried.
constexpr double kLeastPart = 0.2;
constexpr int kScales = 13;
// What a map may take for its scale. A little more than all allows for other proportions.
constexpr double kLeastScale = 0.42, kGreatestScale = 1.05;
// Until then heat around the end of a limb has not come to where the limb may be cut off.
constexpr double kLocalTime = 0.08;
// Vertices that determine a map, and those that do in its refinement.
constexpr int kPartSamples = 400, kRefinedPartSamples = 1000;
// Functions of the template.
const std::vector<int> kPartCoarse = {16, 22, 28, 34, 40}, kPartFine = {45, 50, 55, 60};
const std::vector<int> kPartRefined = {40, 50, 60, 70, 80, 90, 100};
// Of the target at least so many, lest the first maps be constant.
constexpr int kFewestFunctions = 6;
// Pairs of vertices whose distances tell the scale, those from which and those to which; nearer
// ones, and those whose images are nearer, tell nothing.
constexpr size_t kScaleFrom = 12, kScaleTo = 100;
constexpr float kNearOnPart = 0.1F, kNearImages = 0.05F;

// The number of the target's functions that vary no faster than the first `count` of the template.
int TargetCount(const MatchingBody& on_template, int count, const MatchingBody& on_target,
                double scale) {
  const int last = std::min(count, on_template.spectrum.Count()) - 1;
  const double limit = on_template.spectrum.values(last) * scale * scale;
  const auto* const begin = on_target.spectrum.values.data();
  const int most = on_target.spectrum.Count();
  const auto below = static_cast<int>(std::upper_bound(begin, begin + most, limit) - begin);
  return std::min(most, std::max(kFewestFunctions, below));
}

// All that TargetCount can be for up to `count` functions of the template.
std::vector<int> TargetCounts(const MatchingBody& on_template, int count,
                              const MatchingBody& on_target) {
  const int fewest = std::min(kFewestFunctions, on_target.spectrum.Count());
  std::vector<int> counts(TargetCount(on_template, count, on_target, kGreatestScale) - fewest + 1);
  std::iota(counts.begin(), counts.end(), fewest);
  return counts;
}

void ZoomOutPart(const MatchingBody& on_template, const SpectralPoints& first,
                 const MatchingBody& on_target, const SpectralPoints& second,
                 const std::vector<int>& counts, SpectralMap* map) {
  for (const int count : counts) {
    ZoomOutFromPart(first, second, std::min(count, on_template.spectrum.Count()),
                    TargetCount(on_template, count, on_target, map->scale), map);
  }
}

VertexPairs PairsOf(const MatchingBody& on_template, const MatchingBody& on_target,
                    const SpectralMap& map) {
  VertexPairs pairs;
  for (size_t i = 0; i < map.to_template.size(); ++i) {
    pairs.emplace_back(on_template.spread[map.to_template[i]], on_target.spread[i]);
  }
  return pairs;
}

// For each set of pairs the scale under which it costs least.
using BestOfScales = std::map<std::vector<std::pair<int, int>>, ScaledAssignment>;

void Keep(const Assignment& assignment, double scale, BestOfScales* best) {
  const auto [found, is_new] = best->try_emplace(assignment.pairs);
  if (!is_new && found->second.assignment.cost <= assignment.cost) return;
  found->second = {assignment, scale};
}

std::vector<ScaledAssignment> Cheapest(const BestOfScales& best, int count) {
  std::vector<ScaledAssignment> all;
  for (const auto& entry : best) all.push_back(entry.second);
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.assignment.cost < b.assignment.cost;
  });
  all.resize(std::min<size_t>(all.size(), count));
  return all;
}

}  // namespace

std::vector<ScaledAssignment> AssignAtScales(const MatchingBody& on_template,
                                             const Landmarks& template_landmarks,
                                             const MatchingBody& on_target,
                                             const Landmarks& target_landmarks,
                                             const Eigen::MatrixXd& difference, int count) {
  const std::vector<int>& first = on_template.inner_extremities;
  const Eigen::MatrixXd before =
      template_landmarks.Between(static_cast<int>(first.size()), first.size());
  const auto inner = static_cast<int>(on_target.inner_extremities.size()),
             all = static_cast<int>(on_target.part_extremities.size());
  BestOfScales of_inner, on_border;
  for (int k = 0; k < kScales; ++k) {
    const double scale = std::sqrt(kLeastPart + (1 - kLeastPart) * k / (kScales - 1));
    // Of an end on the border heat tells nothing.
    Eigen::MatrixXd unlike = difference;
    unlike.leftCols(inner) += HeatDifference(on_template.spectrum, first, on_target.spectrum,
                                             on_target.inner_extremities, kLocalTime, scale);
    const auto best_of = [&](int ends) {
      const Eigen::MatrixXd after = scale * target_landmarks.Between(ends, all);
      if (after.cols() < kFewestOfAPart) return std::vector<Assignment>();
      return AssignExtremities({before, after, unlike.leftCols(ends)}, count, kFewestOfAPart).best;
    };
    for (const Assignment& assignment : best_of(inner)) Keep(assignment, scale, &of_inner);
    if (all == inner) continue;
    for (const Assignment& assignment : best_of(all)) {
      const bool has_border = std::any_of(assignment.pairs.begin(), assignment.pairs.end(),
                                          [&](const auto& pair) { return pair.second >= inner; });
      if (has_border) Keep(assignment, scale, &on_border);
    }
  }
  std::vector<ScaledAssignment> result = Cheapest(of_inner, count);
  const std::vector<ScaledAssignment> others = Cheapest(on_border, count);
  result.insert(result.end(), others.begin(), others.end());
  return result;
}

std::vector<CandidateMap> MakePartMaps(const MatchingBody& on_template,
                                       const Landmarks& template_landmarks,
                                       const MatchingBody& on_target,
                                       const Landmarks& target_landmarks,
                                       const std::vector<ScaledAssignment>& assignments,
                                       Progress* progress) {
  const SpectralPoints first(on_template.spectrum, on_template.spread, kPartSamples,
                             {std::min(kPartFine.back(), on_template.spectrum.Count())});
  const SpectralPoints second(on_target.spectrum, on_target.spread, kPartSamples,
                              TargetCounts(on_template, kPartFine.back(), on_target));
  std::vector<CandidateMap> maps(assignments.size());
  ReportProgress(progress, "maps", 0, static_cast<int>(maps.size()));
  ParallelFor(static_cast<int>(maps.size()), [&](int i) {
    CandidateMap& candidate = maps[i];
    candidate.assignment = assignments[i].assignment;
    candidate.map.scale = assignments[i].scale;
    const auto [a, b] =
        DescribeBoth(template_landmarks, static_cast<int>(on_template.inner_extremities.size()),
                     target_landmarks, static_cast<int>(on_target.part_extremities.size()),
                     candidate.assignment);
    candidate.map.to_template = NearestColumns(b.leftCols(second.NumSamples()), a);
    for (const std::vector<int>* counts : {&kPartCoarse, &kPartFine}) {
      ZoomOutPart(on_template, first, on_target, second, *counts, &candidate.map);
      candidate.map.scale =
          RelativeScale(on_template, on_target, PairsOf(on_template, on_target, candidate.map));
    }
  });
  RemoveRepeated(on_template, &SpectralMap::to_template, &maps);
  return maps;
}

SpectralMap RefinePartMap(const MatchingBody& on_template, const MatchingBody& on_target,
                          const std::vector<int>& to_template, Progress* progress) {
  ReportProgress(progress, "refined map", 0, 0);
  VertexPairs pairs;
  for (const int v : on_target.spread) pairs.emplace_back(to_template[v], v);
  SpectralMap map;
  map.scale = RelativeScale(on_template, on_target, pairs);
  std::vector<int> target_counts;
  for (const int count : kPartRefined) {
    target_counts.push_back(TargetCount(on_template, count, on_target, map.scale));
  }
  const SpectralPoints first(on_template.spectrum, on_template.spread, kRefinedPartSamples,
                             {std::min(kPartRefined.back(), on_template.spectrum.Count())});
  const SpectralPoints second(on_target.spectrum, on_target.spread, kRefinedPartSamples,
                              target_counts);
  const std::vector<int> nearest = on_template.graph.NearestOf(on_template.spread);
  for (int i = 0; i < second.NumSamples(); ++i) {
    map.to_template.push_back(nearest[pairs[i].first]);
  }
  ZoomOutPart(on_template, first, on_target, second, kPartRefined, &map);
  return map;
}

double RelativeScale(const MatchingBody& on_template, const MatchingBody& on_target,
                     const VertexPairs& pairs) {
  std::vector<float> ratios;
  for (size_t i = 0; i < std::min(kScaleFrom, pairs.size()); ++i) {
    const Eigen::VectorXf before = on_target.graph.From(pairs[i].second),
                          after = on_template.graph.From(pairs[i].first);
    for (size_t k = i + 1; k < std::min(kScaleTo, pairs.size()); ++k) {
      const float on_part = before(pairs[k].second), on_whole = after(pairs[k].first);
      if (on_part > kNearOnPart && on_whole > kNearImages) ratios.push_back(on_whole / on_part);
    }
  }
  if (ratios.empty()) return kLeastScale;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return std::clamp(static_cast<double>(*middle), kLeastScale, kGreatestScale);
}

}  // namespace shapespace::internal
