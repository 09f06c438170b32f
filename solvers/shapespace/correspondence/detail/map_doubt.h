#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_MAP_DOUBT_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_MAP_DOUBT_H_

#include <vector>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/correspondence/detail/candidate_fit.h>
#include <shapespace/correspondence/detail/marker_fit.h>

namespace shapespace::internal {

/// Connected parts of a template that a fit which costs little more than the cheapest sends
/// elsewhere, largest first.
struct MapDoubt {
  std::vector<CorrespondenceSummary::PartInDoubt> parts;  ///< vertices are those of the fits
  std::vector<int> part_of;                               ///< of each vertex; -1 if in none

  /// `fits` of the template onto `target`, cheapest first; at least one.
  MapDoubt(const FitBody& coarse_template, const Shape& target,
           const std::vector<CandidateFit>& fits);
};

/// Cost of the cheapest fit that is another one than the first, as a multiple of the first one's;
/// NaN if there is none.
double Certainty(const Shape& target, const std::vector<CandidateFit>& fits);

/// For each of some vertices of the template the one of a target that is a part of it whose image,
/// a vertex of the template, is nearest; -1 where none is near, which the part lacks.
std::vector<int> InverseOf(const Shape& on_template, const std::vector<int>& vertices,
                           const std::vector<int>& images);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_MAP_DOUBT_H_
