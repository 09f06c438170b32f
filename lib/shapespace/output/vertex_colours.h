#ifndef SHAPESPACE_OUTPUT_VERTEX_COLOURS_H_
#define SHAPESPACE_OUTPUT_VERTEX_COLOURS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/output/skinned_path.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// Colours that show values, for `WriteFrames`: of each shape red, green and blue of every vertex,
/// 3 x m, in sRGB, from 0 to 1.
struct ValueColours {
  std::vector<Eigen::MatrixXd> of_shapes;
  double scale_end = 0;  ///< the value that has the last colour
};

/// Colours by a value of each vertex, one vector for each shape, with the scale of film strips:
/// from light grey-blue for 0 through orange to a dark red, and the same for all shapes.
ValueColours ColourByValue(const std::vector<Eigen::VectorXd>& values);

/// The same by the deviation (`EdgeDeviation`; .01 is one per cent) of each shape from `reference`
/// (3 x m, in the metric's unit; empty: the path's first shape).
ValueColours ColourByDeviation(const Path& path, const Shape& reference = {});

/// Colours of groups, such as rigid parts: 3 x m as above, light grey where `groups` is negative.
Eigen::MatrixXd ColourByGroup(const Eigen::VectorXi& groups);

/// A colour of each bone, mixed at each vertex by its weights: 3 x m as above.
Eigen::MatrixXd ColourByBone(const SkinnedPath& path);

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_VERTEX_COLOURS_H_
