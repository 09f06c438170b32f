#ifndef SHAPESPACE_COST_GATHER_BLOCKS_H_
#define SHAPESPACE_COST_GATHER_BLOCKS_H_

#include <algorithm>

#include <shapespace/metric/feature.h>

namespace shapespace::cost {

/// As Feature::GatherCoordinates, for one element whose vertices are parameter blocks:
/// `block(k)` points at the 3 coordinates of its vertex k.
template <typename Block>
void GatherBlocks(const Feature& feature, int element, const Block& block, double* x) {
  for (int k = 0; k < feature.VerticesPerElement(); ++k) x = std::copy_n(block(k), 3, x);
  std::copy_n(feature.Numbers(element), feature.NumbersPerElement(), x);
}

}  // namespace shapespace::cost

#endif  // SHAPESPACE_COST_GATHER_BLOCKS_H_
