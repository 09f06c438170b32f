#ifndef SHAPESPACE_DEFORMATION_DETAIL_COUNT_INTERSECTIONS_H_
#define SHAPESPACE_DEFORMATION_DETAIL_COUNT_INTERSECTIONS_H_

#include <shapespace/deformation/deformation.h>

namespace shapespace::internal {

/// Sets the number of intersections of a deformation that is complete, and warns of them.
void CountIntersectionsOf(DeformationResult* result);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_DEFORMATION_DETAIL_COUNT_INTERSECTIONS_H_
