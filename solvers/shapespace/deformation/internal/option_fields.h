#ifndef SHAPESPACE_DEFORMATION_INTERNAL_OPTION_FIELDS_H_
#define SHAPESPACE_DEFORMATION_INTERNAL_OPTION_FIELDS_H_

#include <functional>

#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/repair.h>
#include <shapespace/metric/internal/option_fields.h>

// The fields of options, and the words of enumerations (base/internal/fields.h).

namespace shapespace::internal {

inline Words<DeformationOptions::Solver> WordsOf(Of<DeformationOptions::Solver>) {
  return {{"threaded_lbfgs", DeformationOptions::Solver::kThreadedLbfgs},
          {"trust_region", DeformationOptions::Solver::kTrustRegion}};
}

template <typename Visit>
void ForOptions(Of<DeformationOptions>, const Visit& visit) {
  visit("metric", &DeformationOptions::metric,
        "What the deformation costs: a preset's name, or options that differ from those of "
        "MetricOptions::Deformation of the mesh.");
  visit("shapes", &DeformationOptions::shapes,
        "Shapes after the first, the deformed one included: at least one for 90 degrees of a turn; "
        "by default 1 for repairs.");
  visit("balance", &DeformationOptions::balance,
        "Weight of the metric against that of soft handles, in (0, 1]: towards 0 they are met, at "
        "1 they have no effect; by default 0.5 for repairs.");
  visit("tolerance", &DeformationOptions::tolerance,
        "A level is finished when two iterations in a row lower what is minimised by less than "
        "this share of it.");
  visit("max_iterations", &DeformationOptions::max_iterations,
        "Iterations that a level may take; reaching them is reported as not converged.");
  visit("solver", &DeformationOptions::solver,
        "The optimiser; trust_region, which is that of Ceres, is slow beyond a thousand vertices.");
  visit("coarsest", &DeformationOptions::coarsest,
        "Triangles of the coarsest level of the hierarchy.");
  visit("avoid_contact", &DeformationOptions::avoid_contact,
        "Whether the body must not pass through itself: parts give way to each other.");
  visit("obstacle", &DeformationOptions::obstacle,
        "With avoid_contact: a mesh that does not move and that the body must not touch either.");
  visit("memory_limit", &DeformationOptions::memory_limit,
        "Bytes that the solve may take; an estimate above it is refused at once.");
}

template <typename Visit>
void ForOptions(Of<RepairOptions>, const Visit& visit) {
  ForOptionsOfPart(&RepairOptions::deformation, visit);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_DEFORMATION_INTERNAL_OPTION_FIELDS_H_
