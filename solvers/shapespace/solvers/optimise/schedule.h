#ifndef SHAPESPACE_SOLVERS_OPTIMISE_SCHEDULE_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_SCHEDULE_H_

#include <vector>

#include <shapespace/solvers/geodesic.h>

namespace shapespace::internal {

/// One solve on the way from few unknowns to all.
struct ScheduleStep {
  int level;   ///< of the hierarchy, 0 the coarsest
  int shapes;  ///< inner shapes
};

/// The steps of `schedule` on a hierarchy of `levels` levels, to `shapes` inner shapes: the first
/// on the coarsest level that the schedule uses with one inner shape, the last on the finest with
/// all; each has either the level or the number of shapes of one before it.
std::vector<ScheduleStep> MakeSchedule(GeodesicSchedule schedule, int levels, int shapes);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_SCHEDULE_H_
