#ifndef SHAPESPACE_OUTPUT_DETAIL_FRAME_H_
#define SHAPESPACE_OUTPUT_DETAIL_FRAME_H_

#include <Eigen/Core>

#include <shapespace/output/detail/ray_scene.h>
#include <shapespace/output/internal/colour.h>
#include <shapespace/output/internal/view.h>
#include <shapespace/output/picture.h>

namespace shapespace::internal {

/// The background's colour.
Colour Background();

/// The same for all frames of a strip.
struct Camera {
  Axes axes;
  Eigen::Vector2d centre;  ///< of the frame, along the first two axes
  double pixels_per_unit = 1;
  int width = 0, height = 0;  ///< of a frame, in pixels
  int samples = 1;            ///< per pixel and axis
};

/// What determines a shape's colour.
struct Paint {
  ShapeRole role = ShapeRole::kPose;  ///< colour of front faces by default
  bool show_values = false;           ///< show the scene's values, on a scale that ends at 1
  Eigen::VectorXi groups;             ///< group of each vertex; empty: none
  Eigen::VectorXi marks;              ///< mark of each vertex, as in FilmStripOptions; empty: none
};

/// Draws `scene` over the rectangle of `image` whose upper left pixel is (left, top).
void DrawFrame(const RayScene& scene, const Camera& camera, const Paint& paint, int left, int top,
               RgbImage* image);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_FRAME_H_
