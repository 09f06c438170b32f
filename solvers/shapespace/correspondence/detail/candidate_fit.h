#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_CANDIDATE_FIT_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_CANDIDATE_FIT_H_

#include <cstddef>
#include <vector>

#include <shapespace/base/not_computed.h>
#include <shapespace/matching/internal/matching.h>

namespace shapespace::internal {

/// Below this ratio of costs the choice between two maps is in doubt. Of 55 pairs with known
/// answers one was wrong, with 1.08; of 26 pairs of people in poses the right ones had 1.26 or
/// more.
inline constexpr double kDoubt = 1.25;

/// The fit with a candidate's markers, and how unlike the bodies are where it joins them.
struct CandidateFit {
  MapCandidate candidate;
  size_t row = 0;                ///< of the summary's candidates
  std::vector<int> to_target;    ///< of each vertex of the coarse template; -1 if a part has none
  std::vector<int> to_template;  ///< of each vertex of the target, if it is a part
  double deformation = kNotComputed;
  MapFigures figures;
  double reverse = 1;  ///< (d + kAlike) of the deformation d of the target by the reverse fit, as
                       ///< a share of that with the cheapest map; 1 if there is no such fit

  double Cost() const { return (deformation + kAlike) * figures.Cost() * reverse; }
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_CANDIDATE_FIT_H_
