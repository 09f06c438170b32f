#include <shapespace/geodesic/detail/schedule.h>

#include <algorithm>

namespace shapespace::internal {
namespace {

// Numbers of inner shapes from one to `shapes`; each has about half the segments of the next.
std::vector<int> TimeLevels(int shapes) {
  std::vector<int> levels = {shapes};
  while (levels.back() > 1) levels.push_back(std::max(1, (levels.back() - 1) / 2));
  std::reverse(levels.begin(), levels.end());
  return levels;
}

// Up to this number of inner shapes all levels are solved in turn. With fewer shapes on the mesh
// itself, parts would rest and then jump, which there costs little more than even motion, and later
// refinements in time do not correct it. With seven this hardly happens.
constexpr int kShapesOnAllLevels = 7;

}  // namespace

std::vector<ScheduleStep> MakeSchedule(GeodesicSchedule schedule, int levels, int shapes) {
  const std::vector<int> times = TimeLevels(shapes);
  const int finest = levels - 1;
  std::vector<ScheduleStep> steps;
  if (schedule == GeodesicSchedule::kPaper) {
    size_t time = 0;
    int level = 0;
    steps.push_back({0, times[0]});
    while (level < finest || time + 1 < times.size()) {
      if (time + 1 < times.size()) steps.push_back({level, times[++time]});
      if (level < finest) steps.push_back({++level, times[time]});
    }
    return steps;
  }
  const int coarsest = schedule == GeodesicSchedule::kFlat ? finest : 0;
  for (size_t time = 0; time < times.size(); ++time) {
    const bool all_levels = times[time] <= kShapesOnAllLevels;
    for (int level = all_levels ? coarsest : finest; level <= finest; ++level) {
      steps.push_back({level, times[time]});
    }
  }
  return steps;
}

}  // namespace shapespace::internal
