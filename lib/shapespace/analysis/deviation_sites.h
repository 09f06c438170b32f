#ifndef SHAPESPACE_ANALYSIS_DEVIATION_SITES_H_
#define SHAPESPACE_ANALYSIS_DEVIATION_SITES_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// A region in which edges deviate from their lengths in the first shape; usually a joint.
struct DeviationSite {
  int vertex = 0;  ///< with the largest deviation, counted from 0
  /// Of that vertex in the first shape, in the user's frame.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double largest = 0;  ///< `EdgeDeviation` at the vertex, in the worst shape
  double share = 0;    ///< of the whole path's deviation, the integral of its square
  double area_share = 0;
  std::vector<int> parts;  ///< adjacent ones, by descending length of the border
};

/// Connected regions in which the vertices' largest deviation on the path exceeds its root mean
/// square over the surface, in order of descending share. Empty for rigid motion.
std::vector<DeviationSite> FindDeviationSites(const Path& path, const RigidParts& parts);

}  // namespace shapespace

#endif  // SHAPESPACE_ANALYSIS_DEVIATION_SITES_H_
