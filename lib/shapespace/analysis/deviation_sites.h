#ifndef SHAPESPACE_ANALYSIS_DEVIATION_SITES_H_
#define SHAPESPACE_ANALYSIS_DEVIATION_SITES_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// A region where edges deviate from their lengths in the first shape: a joint, mostly.
struct DeviationSite {
  int vertex = 0;  ///< where it is largest, counted from 0
  /// Of that vertex in the first shape, where the user's is.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double largest = 0;  ///< `EdgeDeviation` there, in the worst shape
  double share = 0;    ///< of the whole path's deviation: the integral of its square
  double area_share = 0;
  std::vector<int> parts;  ///< that it touches, the one with the longest border first
};

/// Connected regions in which the vertices' largest deviation on the path exceeds its root mean
/// square over the surface, those with most of it first. Empty for rigid motion.
std::vector<DeviationSite> FindDeviationSites(const Path& path, const RigidParts& parts);

}  // namespace shapespace

#endif  // SHAPESPACE_ANALYSIS_DEVIATION_SITES_H_
