#ifndef SHAPESPACE_CORRESPONDENCE_INTERNAL_OPTION_FIELDS_H_
#define SHAPESPACE_CORRESPONDENCE_INTERNAL_OPTION_FIELDS_H_

#include <shapespace/base/internal/fields.h>
#include <shapespace/correspondence/correspondence.h>

// The fields of options, and the words of enumerations (base/internal/fields.h).

namespace shapespace::internal {

template <typename Visit>
void ForOptions(Of<CorrespondenceOptions>, const Visit& visit) {
  visit("drop_doubtful", &CorrespondenceOptions::drop_doubtful,
        "Leave out markers that contradict the others.");
  visit("find_markers", &CorrespondenceOptions::find_markers,
        "Find markers beside those that are given; with fewer than three they are found in any "
        "case.");
  visit("proportions", &CorrespondenceOptions::proportions,
        "Length over which the ratio of the two bodies' proportions may change, as a share of the "
        "square root of the area.");
  visit("bending", &CorrespondenceOptions::bending,
        "Stiffness of the fitted template: more keeps it from following detail that it does not "
        "have, less lets it fold.");
  visit("tolerance", &CorrespondenceOptions::tolerance,
        "The last rounds end when vertices move by less than this share of the square root of the "
        "area.");
  visit("max_iterations", &CorrespondenceOptions::max_iterations,
        "Rounds that these last may take.");
  visit("coarsest", &CorrespondenceOptions::coarsest,
        "Triangles of the coarsest level of the hierarchy.");
  visit("memory_limit", &CorrespondenceOptions::memory_limit,
        "Bytes that the fit may take; an estimate above it is refused at once.");
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_INTERNAL_OPTION_FIELDS_H_
