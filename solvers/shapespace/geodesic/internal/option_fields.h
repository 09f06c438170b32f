#ifndef SHAPESPACE_GEODESIC_INTERNAL_OPTION_FIELDS_H_
#define SHAPESPACE_GEODESIC_INTERNAL_OPTION_FIELDS_H_

#include <shapespace/geodesic/geodesic.h>
#include <shapespace/metric/internal/option_fields.h>

// The fields of options, and the words of enumerations (base/internal/fields.h).

namespace shapespace::internal {

inline Words<GeodesicSolver> WordsOf(Of<GeodesicSolver>) {
  return {{"automatic", GeodesicSolver::kAutomatic},
          {"lbfgs", GeodesicSolver::kLbfgs},
          {"threaded_lbfgs", GeodesicSolver::kThreadedLbfgs},
          {"trust_region", GeodesicSolver::kTrustRegion}};
}

inline Words<GeodesicSchedule> WordsOf(Of<GeodesicSchedule>) {
  return {{"automatic", GeodesicSchedule::kAutomatic},
          {"paper", GeodesicSchedule::kPaper},
          {"flat", GeodesicSchedule::kFlat}};
}

inline Words<GeodesicStart> WordsOf(Of<GeodesicStart>) {
  return {{"best", GeodesicStart::kBest},
          {"blend", GeodesicStart::kBlend},
          {"first", GeodesicStart::kFirst},
          {"last", GeodesicStart::kLast},
          {"rigid", GeodesicStart::kRigid}};
}

template <typename Visit>
void ForOptions(Of<GeodesicOptions>, const Visit& visit) {
  visit("metric", &GeodesicOptions::metric,
        "What motions cost: a preset's name, or options of the metric.");
  visit("shapes", &GeodesicOptions::shapes,
        "Shapes inserted between neighbouring poses, at least 1.");
  visit("tolerance", &GeodesicOptions::tolerance,
        "A level is finished when an iteration lowers the energy by less than this share of it.");
  visit("max_iterations", &GeodesicOptions::max_iterations,
        "Iterations that a level may take; reaching them is reported as not converged.");
  visit("solver", &GeodesicOptions::solver,
        "The optimiser of each level: lbfgs and trust_region are those of Ceres, threaded_lbfgs is "
        "of this library. Ways round contacts are found by threaded_lbfgs, whichever is given.");
  visit("schedule", &GeodesicOptions::schedule,
        "In which order resolutions in space and time are solved: paper is space and time in turn, "
        "flat has no hierarchy.");
  visit("start", &GeodesicOptions::start,
        "Where the one inner shape of the first solve starts: at a blend of its neighbours, at one "
        "of them, at a rigid motion, or at the best of the first three.");
  visit("coarsest", &GeodesicOptions::coarsest,
        "Triangles of the coarsest level of the hierarchy.");
  visit("memory_limit", &GeodesicOptions::memory_limit,
        "Bytes that the solve may take; an estimate above it is refused at once.");
  visit("assess", &GeodesicOptions::assess,
        "Whether the path is measured for the summary's quality and intersections, which takes up "
        "to a fifth of the time.");
  visit("avoid_contact", &GeodesicOptions::avoid_contact,
        "Whether the path must not pass through itself: takes the least way round that it finds.");
  visit("via", &GeodesicOptions::via,
        "With avoid_contact, between two poses: shapes near which the way round leads, if it is "
        "not found without.");
  visit("obstacle", &GeodesicOptions::obstacle,
        "With avoid_contact: a mesh that does not move and that the body must not touch either; "
        "the poses are where they are to be beside it.");
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_INTERNAL_OPTION_FIELDS_H_
