#ifndef SHAPESPACE_OUTPUT_VERTEX_COLOURS_H_
#define SHAPESPACE_OUTPUT_VERTEX_COLOURS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/path/path.h>

namespace shapespace {

/// Colours of all shapes of a path, for `WriteFrames`: of each shape red, green and blue of every
/// vertex, 3 x m, in sRGB, from 0 to 1.
struct DeviationColours {
  std::vector<Eigen::MatrixXd> of_shapes;
  double scale_end = 0;  ///< the deviation that has the last colour; .01 is one per cent
};

/// Colours by the deviation (`EdgeDeviation`) of each shape from `reference` (3 x m, in the
/// metric's unit; empty: the path's first shape), with the scale of film strips: from light
/// grey-blue through orange to a dark red, and the same for all shapes.
DeviationColours ColourByDeviation(const Path& path, const Shape& reference = {});

/// Colours of groups, such as rigid parts: 3 x m as above, light grey where `groups` is negative.
Eigen::MatrixXd ColourByGroup(const Eigen::VectorXi& groups);

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_VERTEX_COLOURS_H_
