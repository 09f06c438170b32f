#include <shapespace/solvers/optimise/minimise.h>
#include <shapespace/solvers/optimise/residual_blocks.h>

namespace shapespace::internal {

MinimiseResult MinimiseTrustRegion(const Metric& metric, double quartic_weight,
                                   const MinimiseOptions& options, std::vector<Shape>* shapes) {
  ResidualBlocks blocks;
  blocks.AddPathEnergy(metric, quartic_weight, shapes);
  blocks.Fix(&shapes->front());
  blocks.Fix(&shapes->back());
  return blocks.Minimise(options);
}

}  // namespace shapespace::internal
