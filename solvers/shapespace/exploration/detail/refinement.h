#ifndef SHAPESPACE_EXPLORATION_DETAIL_REFINEMENT_H_
#define SHAPESPACE_EXPLORATION_DETAIL_REFINEMENT_H_

#include <shapespace/exploration/detail/pair_solver.h>
#include <shapespace/exploration/explore.h>

// Inserts midpoints of geodesics between nodes.

namespace shapespace::internal {

/// Splits triangles or segments of a space whose edges differ too much from geodesics, as described
/// at `Explore`; adds the rounds to the summary.
/// \throw as PairSolver::Solve.
void Refine(const ExploreOptions& options, PairSolver* solver, Progress* progress, PoseSpace* space,
            ExploreSummary* summary);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPLORATION_DETAIL_REFINEMENT_H_
