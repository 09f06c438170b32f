#include <shapespace/correspondence/detail/found_markers.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/base/internal/task_group.h>
#include <shapespace/correspondence/detail/candidate_fit.h>
#include <shapespace/correspondence/detail/check_input.h>
#include <shapespace/correspondence/detail/coarse_body.h>
#include <shapespace/correspondence/detail/map_doubt.h>
#include <shapespace/correspondence/detail/marker_distances.h>
#include <shapespace/correspondence/detail/nearest_corners.h>
#include <shapespace/correspondence/detail/smooth_stretch.h>
#include <shapespace/matching/internal/matching.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace::internal {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

// Fits that deform the template more than this are guesses.
constexpr double kUnlike = 0.5;
// The same of parts. Of 69 targets without 30 % of their area 16 had more than this, of which eight
// were wrong, and of the others three.
constexpr double kUnlikePart = 0.32;
// Of targets that show less of the body than this, as those seen from one side, most maps are wrong
// if no marker is given.
constexpr double kShowsLittle = 0.45;

// Candidates are found and fitted on bodies with so many triangles, if the given ones have more
// than twice as many: 50 for each wave of the functions of which maps are made. Finer ones take
// more time and tell nothing more.
constexpr int kSearchedOn = 10000;
// The markers of the last fit are those on which fits of the template and of the target onto each
// other agree, with so many triangles: of so many vertices those whose places in both are no
// farther apart than this.
constexpr int kFittedBothWaysOn = 4000;
constexpr size_t kMarkersOfBoth = 200;
constexpr double kAgree = 0.1;
// The caller is told so many of the found ones, which a person can look at and mend.
constexpr size_t kMarkersTold = 40;

// Candidates whose rough fit costs more than this many times as much as the cheapest are given up.
// Of 26 pairs on which this was chosen the map that is the cheapest in the end had 1.4 times at
// most, and those that end with less than 1.48 times its cost had 1.75 at most.
constexpr double kGivenUp = 2;

// Candidates of a part are judged by fits of it with so many triangles, which find the same maps as
// those with twice as many.
constexpr int kPartFittedOn = 1000;
// Fits of a part that cost less than this many times as much as the cheapest are repeated so many
// times, each with markers of the map that the one before it makes. Of ten cut bodies the right map
// began with up to 1.7 times the cost of the wrong one that was the cheapest, and ended below it.
constexpr double kRepeatedBelow = 2;
constexpr int kRepeats = 2;
// Markers with which the template is fitted to a part.
constexpr size_t kMarkersOfPart = 60;

using Markers = std::vector<CorrespondenceMarker>;

// The markers on a coarser template.
Markers On(const CoarseBody& from, Markers markers) {
  for (CorrespondenceMarker& marker : markers) {
    marker.template_vertex = from.IndexOf(marker.template_vertex);
  }
  return markers;
}

// How unlike what was fitted has become to itself.
double Deformation(const SmoothStretch& stretch, const OwnFrame& frame,
                   const CorrespondenceResult& fit) {
  return stretch.Cost(frame.In(fit.fitted)) + fit.summary.uncovered + fit.summary.turned;
}

// The same of a target that is a part of what the template is: of the latter it covers as much as
// the distances between markers say.
double PartDeformation(const SmoothStretch& stretch, const FitBody& part, const OwnFrame& frame,
                       const CorrespondenceResult& fit) {
  const double scale = fit.summary.scale * part.frame.unit / frame.unit;
  return stretch.Cost(frame.In(fit.fitted) / scale) + fit.summary.turned;
}

class Finder {
 public:
  Finder(const FitBody& from, const FitBody& target, const Markers& given,
         const CorrespondenceOptions& options, const CorrespondenceSummary& begun,
         Progress* progress)
      : whole_from_(from),
        whole_target_(target),
        options_(options),
        begun_(begun),
        progress_(progress),
        searched_from_(Coarsen(from, kSearchedOn,
                               MarkerVertices(given, &CorrespondenceMarker::template_vertex))),
        searched_target_(Coarsen(target, kSearchedOn,
                                 MarkerVertices(given, &CorrespondenceMarker::target_vertex))),
        from_(searched_from_.body),
        target_(searched_target_.body),
        given_(given),
        matcher_(*from_.connectivity, from_.own, *target_.connectivity, target_.own, {}, progress) {
    for (CorrespondenceMarker& marker : given_) {
      marker.template_vertex = searched_from_.IndexOf(marker.template_vertex);
      marker.target_vertex = searched_target_.IndexOf(marker.target_vertex);
      given_pairs_.emplace_back(marker.template_vertex, marker.target_vertex);
    }
  }

  CorrespondenceResult Find() {
    matching_ = matcher_.FindCandidates(given_pairs_, progress_);
    if (matching_.candidates.empty()) {
      throw MeshError("no correspondence was found without markers: " + matching_.problem +
                      "; give three markers or more");
    }
    const double matching_seconds = stopwatch_.Seconds();
    for (const MapCandidate& candidate : matching_.candidates) {
      rows_.emplace_back();
      rows_.back().orientation = candidate.orientation;
      rows_.back().markers = static_cast<int>(candidate.markers.size());
    }
    if (matcher_.TargetIsPart()) {
      FitPartCandidates();
    } else {
      FitCandidates();
    }
    for (const CandidateFit& fit : fits_) rows_[fit.row].cost = fit.Cost();
    rows_[fits_[0].row].chosen = true;
    CorrespondenceResult result = FitWhole(fits_[0]);

    CorrespondenceSummary& summary = result.summary;
    summary.candidates = rows_;
    summary.template_extremities = matching_.template_extremities;
    summary.target_extremities = matching_.target_extremities;
    summary.matching_seconds = matching_seconds;
    summary.certainty = Certainty(target_.own, fits_);
    summary.parts_in_doubt = parts_;
    result.in_doubt = in_doubt_;
    for (const CorrespondenceSummary::PartInDoubt& part : parts_) {
      summary.warnings.push_back(
          Format("%.2g %% of the template may belong elsewhere: its vertex %d is at the target's "
                 "vertex %d, and at vertex %d in another map that costs %.2f times as much. If the "
                 "picture shows that it is wrong, give one marker there",
                 100 * part.share, part.vertex + 1, part.target_vertex + 1, part.other_vertex + 1,
                 part.cost));
    }
    const double deformation = fits_[0].deformation;
    if (!matcher_.TargetIsPart()) {
      if (deformation > kUnlike) {
        summary.warnings.push_back("the bodies differ much in their proportions (deformation " +
                                   Format("%.2f", deformation) +
                                   "): the map is a guess; check the picture");
      }
    } else if (SeenShare(summary) < kShowsLittle) {
      summary.warnings.push_back(
          Format("the target shows some %.0f %% of the body: most such maps are wrong without a "
                 "marker, half of them with two that are far apart, few with twelve; check the "
                 "picture",
                 100 * SeenShare(summary)));
    } else if (deformation > kUnlikePart) {
      summary.warnings.push_back(
          "the target lacks a part of the body, and is much deformed where it was found "
          "(deformation " +
          Format("%.2f", deformation) +
          "): half of such maps are wrong; check the picture, and give a marker or two");
    } else {
      summary.warnings.emplace_back(
          "the target lacks a part of the body: one in twenty such maps is wrong, and looks sure; "
          "check the picture, and give a marker or two if it shows a wrong one");
    }
    return result;
  }

 private:
  // The target's area as a share of the template's, both in one size.
  double SeenShare(const CorrespondenceSummary& summary) const {
    const double ratio = whole_target_.frame.unit / (summary.scale * whole_from_.frame.unit);
    return ratio * ratio;
  }

  // The given markers, and those of the pairs behind them.
  Markers All(const Pairs& pairs) const {
    Markers markers = given_;
    for (size_t i = given_.size(); i < pairs.size(); ++i) {
      markers.push_back({pairs[i].first, pairs[i].second, true});
    }
    return markers;
  }

  CorrespondenceResult Fit(const CoarseBody& body, const FitBody& target, const Markers& markers,
                           Progress* progress, Effort effort = Effort::kKeepFolds) const {
    CorrespondenceResult result = FitWithMarkers(body.body, target, On(body, markers),
                                                 given_.size(), options_, begun_, effort, progress);
    if (result.summary.cancelled) throw Cancelled();
    return result;
  }

  // Fits the coarsened template with the markers of each candidate that a rough fit does not rule
  // out; cheapest first.
  void FitCandidates() {
    Markers all = given_;
    for (const MapCandidate& candidate : matching_.candidates) {
      const Markers markers = All(candidate.markers);
      all.insert(all.end(), markers.begin(), markers.end());
    }
    const CoarseBody coarse = Coarsen(from_, options_.coarsest,
                                      MarkerVertices(all, &CorrespondenceMarker::template_vertex));
    const SmoothStretch stretch(coarse.body.connectivity, coarse.body.own, options_.proportions);

    const auto fit_candidate = [&](int i, Progress* own, Effort effort) {
      const MapCandidate& candidate = matching_.candidates[i];
      const CorrespondenceResult result = Fit(coarse, target_, All(candidate.markers), own, effort);
      CandidateFit fit;
      fit.candidate = candidate;
      fit.to_target = NearestCorners(result.map.to_target, *target_.connectivity);
      fit.deformation = Deformation(stretch, target_.frame, result);
      fit.figures = matcher_.Compare(coarse.vertices, fit.to_target);
      return fit;
    };
    FitAll("rough fits", AllCandidates(),
           [&](int i, Progress* own) { return fit_candidate(i, own, Effort::kRough); });
    std::vector<int> promising;
    for (const CandidateFit& fit : fits_) {
      rows_[fit.row].rough_cost = fit.Cost();
      if (fit.Cost() > kGivenUp * fits_[0].Cost()) continue;
      promising.push_back(static_cast<int>(fit.row));
    }
    FitAll("candidates", promising,
           [&](int i, Progress* own) { return fit_candidate(i, own, Effort::kKeepFolds); });
    for (const CandidateFit& fit : fits_) Tell(fit);
    FitReverse();
    FindParts(coarse);
  }

  static Markers Reversed(Markers markers) {
    for (CorrespondenceMarker& marker : markers) {
      std::swap(marker.template_vertex, marker.target_vertex);
    }
    return markers;
  }

  // A fit of a target that is a part, all of which has a place on the template.
  CandidateFit FitPart(const MapCandidate& candidate, Progress* progress) const {
    const Markers markers = Reversed(All(candidate.markers));
    const CoarseBody coarse = Coarsen(
        target_, kPartFittedOn, MarkerVertices(markers, &CorrespondenceMarker::template_vertex));
    const SmoothStretch stretch(coarse.body.connectivity, coarse.body.own, options_.proportions);
    const CorrespondenceResult result = Fit(coarse, from_, markers, progress);
    const std::vector<int> of_coarse = NearestCorners(result.map.to_target, *from_.connectivity);
    CandidateFit fit;
    fit.candidate = candidate;
    fit.deformation = PartDeformation(stretch, coarse.body, from_.frame, result);
    fit.figures = matcher_.Compare(of_coarse, coarse.vertices);
    fit.to_template = ImagesOfAll(target_, coarse, of_coarse);
    return fit;
  }

  // Fits the part onto the template with each candidate's markers; cheapest first.
  void FitPartCandidates() {
    FitAll("candidates", AllCandidates(),
           [&](int i, Progress* own) { return FitPart(matching_.candidates[i], own); });
    const double most = kRepeatedBelow * fits_[0].Cost();
    const auto count = static_cast<int>(std::count_if(
        fits_.begin(), fits_.end(), [&](const auto& fit) { return fit.Cost() < most; }));
    TaskGroup(progress_, "better markers", count).RunAll(count, [&](int i, Progress* own) {
      CandidateFit& best = fits_[i];
      CandidateFit last = best;
      try {
        for (int repeat = 0; repeat < kRepeats; ++repeat) {
          last.candidate.markers =
              matcher_.RefinePartMarkers(last.candidate, last.to_template, given_pairs_, own);
          last = FitPart(last.candidate, own);
          last.row = best.row;
          if (last.Cost() < best.Cost()) best = last;
        }
      } catch (const MeshError&) {
        // The fit's own map is no better: its markers contradict each other. The best remains.
      }
    });
    const CoarseBody coarse = Coarsen(from_, options_.coarsest, {});
    for (CandidateFit& fit : fits_) {
      fit.to_target = InverseOf(from_.own, coarse.vertices, fit.to_template);
    }
    for (const CandidateFit& fit : fits_) Tell(fit);
    CheapestFirst();
    FindParts(coarse);
  }

  std::vector<int> AllCandidates() const {
    std::vector<int> all(matching_.candidates.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }

  // Makes the fits of these candidates by fit_candidate(i, progress) -> CandidateFit; cheapest
  // first.
  template <typename FitCandidate>
  void FitAll(const char* what, const std::vector<int>& candidates,
              const FitCandidate& fit_candidate) {
    const auto count = static_cast<int>(candidates.size());
    std::vector<std::optional<CandidateFit>> fits(count);
    std::vector<std::string> problems(count);
    TaskGroup(progress_, what, count).RunAll(count, [&](int i, Progress* own) {
      try {
        fits[i].emplace(fit_candidate(candidates[i], own));
        fits[i]->row = candidates[i];
      } catch (const MeshError& error) {
        problems[i] = error.what();  // its markers contradict each other
      }
    });
    fits_.clear();
    for (auto& fit : fits) {
      if (fit) fits_.push_back(std::move(*fit));
    }
    if (fits_.empty()) throw MeshError(problems.front());
    CheapestFirst();
  }

  // Says the figures of a fit in its row.
  void Tell(const CandidateFit& fit) {
    CorrespondenceSummary::Candidate& row = rows_[fit.row];
    row.markers = static_cast<int>(fit.candidate.markers.size());
    row.deformation = fit.deformation;
    row.isometry = fit.figures.isometry;
    row.curvature = fit.figures.curvature;
    row.heat = fit.figures.heat;
  }

  void CheapestFirst() {
    std::stable_sort(fits_.begin(), fits_.end(), [](const CandidateFit& a, const CandidateFit& b) {
      return a.Cost() < b.Cost();
    });
  }

  // Where several maps cost nearly the same, the target is fitted onto the template with each of
  // them too: a wrong map that is cheap in one direction seldom is in the other.
  void FitReverse() {
    const auto end = std::find_if(fits_.begin(), fits_.end(), [&](const CandidateFit& fit) {
      return fit.Cost() > kDoubt * fits_[0].Cost();
    });
    const auto count = static_cast<int>(end - fits_.begin());
    if (count < 2) return;
    std::vector<Markers> reversed;
    Markers all;
    for (int i = 0; i < count; ++i) {
      reversed.push_back(Reversed(All(fits_[i].candidate.markers)));
      all.insert(all.end(), reversed[i].begin(), reversed[i].end());
    }
    const CoarseBody coarse = Coarsen(target_, options_.coarsest,
                                      MarkerVertices(all, &CorrespondenceMarker::template_vertex));
    const SmoothStretch stretch(coarse.body.connectivity, coarse.body.own, options_.proportions);
    std::vector<double> deformations(count);
    TaskGroup(progress_, "the reverse", count).RunAll(count, [&](int i, Progress* own) {
      const CorrespondenceResult result = Fit(coarse, from_, reversed[i], own);
      deformations[i] = Deformation(stretch, from_.frame, result);
    });
    for (int i = 0; i < count; ++i) {
      fits_[i].reverse = (deformations[i] + kAlike) / (deformations[0] + kAlike);
      rows_[fits_[i].row].reverse = deformations[i];
    }
    CheapestFirst();
  }

  // Says which parts of the template are in doubt, with vertices of the whole bodies.
  void FindParts(const CoarseBody& coarse) {
    MapDoubt doubt(coarse.body, target_.own, fits_);
    for (CorrespondenceSummary::PartInDoubt& part : doubt.parts) {
      part.vertex = searched_from_.vertices[coarse.vertices[part.vertex]];
      part.target_vertex = searched_target_.vertices[part.target_vertex];
      part.other_vertex = searched_target_.vertices[part.other_vertex];
    }
    parts_ = std::move(doubt.parts);
    std::vector<int> part_on_searched;
    for (const int v : matcher_.NearestOf(coarse.vertices)) {
      part_on_searched.push_back(v < 0 ? -1 : doubt.part_of[v]);
    }
    for (const int v :
         NearestOf(*whole_from_.connectivity, whole_from_.own, searched_from_.vertices)) {
      in_doubt_.push_back(v < 0 ? -1 : part_on_searched[searched_from_.IndexOf(v)]);
    }
  }

  // Of each vertex of the body the image of the coarse one that is nearest along the surface.
  // Vertices of components that have none are as good as anywhere.
  static std::vector<int> ImagesOfAll(const FitBody& body, const CoarseBody& coarse,
                                      const std::vector<int>& images) {
    std::vector<int> all;
    for (const int v : NearestOf(*body.connectivity, body.own, coarse.vertices)) {
      all.push_back(v < 0 ? 0 : images[coarse.IndexOf(v)]);
    }
    return all;
  }

  // The map of all vertices of one body to the other that a fit makes.
  std::vector<int> MapByFit(const FitBody& body, const FitBody& onto, const Markers& markers,
                            Progress* progress) const {
    const CoarseBody coarse = Coarsen(
        body, kFittedBothWaysOn, MarkerVertices(markers, &CorrespondenceMarker::template_vertex));
    const CorrespondenceResult fit = Fit(coarse, onto, markers, progress);
    return ImagesOfAll(body, coarse, NearestCorners(fit.map.to_target, *onto.connectivity));
  }

  // Markers all over the bodies, where fits in both directions agree. Of bodies that differ much
  // each has limbs that are not reached in one of the directions.
  Markers MarkersOfBothWays(const Markers& markers) const {
    std::vector<int> to_target, to_template;
    TaskGroup(progress_, "both ways", 2).RunAll(2, [&](int i, Progress* own) {
      if (i == 0) {
        to_target = MapByFit(from_, target_, markers, own);
      } else {
        to_template = MapByFit(target_, from_, Reversed(markers), own);
      }
    });
    const Pairs pairs = matcher_.SpreadPairs(to_template, kMarkersOfBoth, given_pairs_);
    Pairs agreed = given_pairs_;
    for (size_t i = given_pairs_.size(); i < pairs.size(); ++i) {
      const auto& [from, to] = pairs[i];
      if ((target_.own.col(to_target[from]) - target_.own.col(to)).norm() < kAgree) {
        agreed.push_back(pairs[i]);
      }
    }
    return All(agreed);
  }

  // Markers for the whole template, all over what it has in common with the target.
  Markers FinalMarkers(const CandidateFit& chosen) const {
    if (matcher_.TargetIsPart()) {
      return All(matcher_.SpreadPairs(chosen.to_template, kMarkersOfPart, given_pairs_));
    }
    return MarkersOfBothWays(All(chosen.candidate.markers));
  }

  CorrespondenceResult FitWhole(Markers markers) const {
    for (CorrespondenceMarker& marker : markers) {
      marker.template_vertex = searched_from_.vertices[marker.template_vertex];
      marker.target_vertex = searched_target_.vertices[marker.target_vertex];
    }
    CorrespondenceResult result = FitWithMarkers(whole_from_, whole_target_, markers, given_.size(),
                                                 options_, begun_, Effort::kUnfold, progress_);
    // The first ones are spread over the body.
    std::set<int> told;
    for (size_t i = 0; i < std::min(markers.size(), given_.size() + kMarkersTold); ++i) {
      told.insert(markers[i].template_vertex);
    }
    result.markers.erase(std::remove_if(result.markers.begin(), result.markers.end(),
                                        [&](const CorrespondenceMarker& marker) {
                                          return told.count(marker.template_vertex) == 0;
                                        }),
                         result.markers.end());
    return result;
  }

  CorrespondenceResult FitWhole(const CandidateFit& chosen) const {
    try {
      return FitWhole(FinalMarkers(chosen));
    } catch (const SolverError&) {
      // The bodies have so little in common that triangles collapse between so many markers. With
      // the candidate's own, which are fewer, it has been fitted.
      return FitWhole(All(chosen.candidate.markers));
    }
  }

  const Stopwatch stopwatch_;
  const FitBody &whole_from_, &whole_target_;
  const CorrespondenceOptions& options_;
  const CorrespondenceSummary& begun_;
  Progress* const progress_;
  // The bodies on which all but the last fit is done. Vertices below are theirs.
  const CoarseBody searched_from_, searched_target_;
  const FitBody &from_, &target_;
  Markers given_;
  Pairs given_pairs_;
  const SurfaceMatcher matcher_;
  Matching matching_;
  std::vector<CandidateFit> fits_;
  // What the caller is told, with vertices of the whole bodies.
  std::vector<CorrespondenceSummary::Candidate> rows_;
  std::vector<CorrespondenceSummary::PartInDoubt> parts_;
  std::vector<int> in_doubt_;
};

}  // namespace

CorrespondenceResult FitWithFoundMarkers(const FitBody& from, const FitBody& target,
                                         const std::vector<CorrespondenceMarker>& given,
                                         const CorrespondenceOptions& options,
                                         const CorrespondenceSummary& summary, Progress* progress) {
  CheckMarkerVertices(given, *from.connectivity, *target.connectivity);
  return Finder(from, target, given, options, summary, progress).Find();
}

}  // namespace shapespace::internal
