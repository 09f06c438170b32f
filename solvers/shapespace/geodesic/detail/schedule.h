#ifndef SHAPESPACE_GEODESIC_DETAIL_SCHEDULE_H_
#define SHAPESPACE_GEODESIC_DETAIL_SCHEDULE_H_

#include <vector>

#include <shapespace/geodesic/geodesic.h>

namespace shapespace::internal {

/// One solve of a coarse-to-fine schedule.
struct ScheduleStep {
  int level;   ///< of the hierarchy, 0 the coarsest
  int shapes;  ///< inner shapes
};

/// The steps of `schedule` on a hierarchy of `levels` levels with `shapes` inner shapes at the end.
/// The first step has one inner shape on the coarsest level of the schedule, the last step all
/// shapes on the finest; each step has the level or the number of shapes of an earlier one.
std::vector<ScheduleStep> MakeSchedule(GeodesicSchedule schedule, int levels, int shapes);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_DETAIL_SCHEDULE_H_
