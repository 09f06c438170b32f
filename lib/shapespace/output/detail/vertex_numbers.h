#ifndef SHAPESPACE_OUTPUT_DETAIL_VERTEX_NUMBERS_H_
#define SHAPESPACE_OUTPUT_DETAIL_VERTEX_NUMBERS_H_

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>
#include <shapespace/output/detail/frame.h>
#include <shapespace/output/detail/ray_scene.h>
#include <shapespace/output/picture.h>

namespace shapespace::internal {

/// Writes the numbers of visible vertices beside them, into the frame whose upper left pixel is
/// (left, top): above on the right where there is room, else at another side, so that numbers do
/// not cover each other if possible. `scene` contains `shape`; `numbers` has one number a vertex,
/// of which 0 is not written, or is empty.
void DrawVertexNumbers(const RayScene& scene, const Shape& shape, const Camera& camera,
                       const Eigen::VectorXi& numbers, int text_size, int left, int top,
                       RgbImage* image);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_VERTEX_NUMBERS_H_
