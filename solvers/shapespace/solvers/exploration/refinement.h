#ifndef SHAPESPACE_SOLVERS_EXPLORATION_REFINEMENT_H_
#define SHAPESPACE_SOLVERS_EXPLORATION_REFINEMENT_H_

#include <shapespace/solvers/exploration/explore.h>
#include <shapespace/solvers/exploration/pair_solver.h>

// Private: shapes half way between nodes, where they are needed.

namespace shapespace::internal {

/// Splits triangles or segments of a space whose edges are too far from geodesics, as `Explore`
/// says; tells the summary. \throw as PairSolver::Solve.
void Refine(const ExploreOptions& options, PairSolver* solver, Progress* progress, Space* space,
            ExploreSummary* summary);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_EXPLORATION_REFINEMENT_H_
