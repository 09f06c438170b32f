#ifndef SHAPESPACE_MATCHING_DETAIL_BORDER_H_
#define SHAPESPACE_MATCHING_DETAIL_BORDER_H_

#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// The border of an open surface: edges that belong to one triangle.
struct SurfaceBorder {
  std::vector<int> vertices;  ///< ends of such edges, in ascending order
  double longest = 0;         ///< length of its longest connected part

  SurfaceBorder(const Connectivity& connectivity, const Shape& shape);
};

/// A surface of area 1 with a longer border lacks a part; one with shorter ones is complete but for
/// holes, each of which, if it were a disc, had at most a fiftieth of the area. A border around a
/// man's thigh has 0.4 to 0.6, around both feet's soles 0.4 each, around his trunk 0.7.
inline constexpr double kLongestHole = 0.5;

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_BORDER_H_
