#include <shapespace/correspondence/detail/found_markers.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/correspondence/detail/nearest_corners.h>
#include <shapespace/correspondence/detail/smooth_stretch.h>
#include <shapespace/matching/internal/matching.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace::internal {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

// Two fits are the same one if fewer than this share of the vertices are farther apart than this
// share of the square root of the area.
constexpr double kOtherShare = 0.1, kApart = 0.1;
// Below this ratio of costs the choice between two fits is in doubt. Of 40 pairs with known answers
// the ones that were wrong had 1.05, and the right ones 1.15 or more.
constexpr double kDoubt = 1.15;
// Fits that deform the template more than this are guesses.
constexpr double kUnlike = 0.5;

// A candidate's fit.
struct CandidateFit {
  MapCandidate candidate;
  CorrespondenceResult result;
  std::vector<int> to_target;  // of each vertex of the template
  double deformation = kNotComputed;

  double Cost() const { return deformation * candidate.Cost(); }
};

class Finder {
 public:
  Finder(const FitBody& from, const FitBody& target, const std::vector<CorrespondenceMarker>& given,
         const CorrespondenceOptions& options, const CorrespondenceSummary& begun,
         Progress* progress)
      : from_(from),
        target_(target),
        given_(given),
        options_(options),
        begun_(begun),
        progress_(progress),
        matcher_(*from.connectivity, from.own, *target.connectivity, target.own, {}, progress),
        stretch_(from.connectivity, from.own, options.proportions) {
    for (const CorrespondenceMarker& marker : given) {
      given_pairs_.emplace_back(marker.template_vertex, marker.target_vertex);
    }
  }

  CorrespondenceResult Find() {
    const Stopwatch stopwatch;
    matching_ = matcher_.FindCandidates(given_pairs_, progress_);
    if (matching_.candidates.empty()) {
      throw MeshError("no correspondence was found without markers: " + matching_.problem +
                      "; give three markers or more");
    }
    const double matching_seconds = matcher_.Seconds() + stopwatch.Seconds();
    for (const MapCandidate& candidate : matching_.candidates) Try(candidate);
    if (fits_.empty()) throw MeshError(problem_);
    std::stable_sort(fits_.begin(), fits_.end(), [](const CandidateFit& a, const CandidateFit& b) {
      return a.Cost() < b.Cost();
    });
    for (CorrespondenceSummary::Candidate& row : rows_) row.chosen = row.cost == fits_[0].Cost();
    const std::optional<size_t> other = Other();
    double certainty = kNotComputed;
    if (other) certainty = fits_[*other].Cost() / fits_[0].Cost();
    if (!fits_[0].result.summary.cancelled) FitAgain();

    CorrespondenceSummary& summary = fits_[0].result.summary;
    summary.candidates = rows_;
    summary.template_extremities = matching_.template_extremities;
    summary.target_extremities = matching_.target_extremities;
    summary.matching_seconds = matching_seconds;
    summary.certainty = certainty;
    if (certainty < kDoubt) {
      summary.warnings.push_back(
          "two maps are almost equally good (one costs " + Format("%.2f", certainty) +
          " times the other): " + Difference(fits_[0].candidate, fits_[*other].candidate) +
          ". If the picture shows the wrong one, give one marker there");
    }
    if (fits_[0].deformation > kUnlike) {
      summary.warnings.push_back("the bodies differ much in their proportions (deformation " +
                                 Format("%.2f", fits_[0].deformation) +
                                 "): the map is a guess; check the picture");
    }
    return std::move(fits_[0].result);
  }

 private:
  std::vector<CorrespondenceMarker> Markers(const Pairs& pairs) const {
    std::vector<CorrespondenceMarker> markers = given_;
    for (size_t i = given_.size(); i < pairs.size(); ++i) {
      markers.push_back({pairs[i].first, pairs[i].second, true});
    }
    return markers;
  }

  CandidateFit FitOf(const MapCandidate& candidate, const Pairs& markers) const {
    CandidateFit fit;
    fit.candidate = candidate;
    fit.result = FitWithMarkers(from_, target_, Markers(markers), given_.size(), options_, begun_,
                                progress_);
    fit.to_target = NearestCorners(fit.result.map.to_target, *target_.connectivity);
    const CorrespondenceSummary& summary = fit.result.summary;
    fit.deformation =
        stretch_.Cost(target_.frame.In(fit.result.fitted)) + summary.uncovered + summary.turned;
    return fit;
  }

  // A candidate whose markers contradict each other cannot be fitted.
  void Try(const MapCandidate& candidate) {
    CorrespondenceSummary::Candidate row;
    row.isometry = candidate.isometry;
    row.curvature = candidate.curvature;
    row.orientation = candidate.orientation;
    row.markers = static_cast<int>(candidate.markers.size());
    try {
      fits_.push_back(FitOf(candidate, candidate.markers));
      row.deformation = fits_.back().deformation;
      row.cost = fits_.back().Cost();
    } catch (const MeshError& error) {
      problem_ = error.what();
    }
    rows_.push_back(row);
  }

  // The best fit that is another one than the first.
  std::optional<size_t> Other() const {
    const Shape& goal = target_.own;
    for (size_t i = 1; i < fits_.size(); ++i) {
      double apart = 0;
      for (size_t v = 0; v < fits_[0].to_target.size(); ++v) {
        const Eigen::Vector3d way =
            goal.col(fits_[i].to_target[v]) - goal.col(fits_[0].to_target[v]);
        if (way.norm() > kApart) ++apart;
      }
      if (apart >= kOtherShare * static_cast<double>(fits_[0].to_target.size())) return i;
    }
    return {};
  }

  // What the other candidate maps elsewhere: the first such extremity.
  static std::string Difference(const MapCandidate& chosen, const MapCandidate& other) {
    for (const auto& [on_template, on_target] : chosen.extremities) {
      for (const auto& [same, elsewhere] : other.extremities) {
        if (same != on_template || elsewhere == on_target) continue;
        return "vertex " + std::to_string(on_template + 1) + " of the template belongs to vertex " +
               std::to_string(on_target + 1) + " of the target, or to vertex " +
               std::to_string(elsewhere + 1);
      }
    }
    return "they differ between the ends of limbs";
  }

  // With the markers of a map of functions that the chosen fit makes; kept if it deforms less.
  void FitAgain() {
    CandidateFit& best = fits_[0];
    const Pairs markers = matcher_.RefineMarkers(
        best.candidate, best.to_target,
        NearestCorners(best.result.map.to_template, *from_.connectivity), given_pairs_, progress_);
    try {
      CandidateFit again = FitOf(best.candidate, markers);
      if (again.deformation < best.deformation) best = std::move(again);
    } catch (const MeshError&) {
      // The first fit remains.
    }
  }

  const FitBody &from_, &target_;
  const std::vector<CorrespondenceMarker>& given_;
  const CorrespondenceOptions& options_;
  const CorrespondenceSummary& begun_;
  Progress* const progress_;
  Pairs given_pairs_;
  const SurfaceMatcher matcher_;
  const SmoothStretch stretch_;
  Matching matching_;
  std::vector<CandidateFit> fits_;
  std::vector<CorrespondenceSummary::Candidate> rows_;
  std::string problem_;  // of a candidate that could not be fitted
};

}  // namespace

CorrespondenceResult FitWithFoundMarkers(const FitBody& from, const FitBody& target,
                                         const std::vector<CorrespondenceMarker>& given,
                                         const CorrespondenceOptions& options,
                                         const CorrespondenceSummary& summary, Progress* progress) {
  return Finder(from, target, given, options, summary, progress).Find();
}

}  // namespace shapespace::internal
