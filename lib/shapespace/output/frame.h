#ifndef SHAPESPACE_OUTPUT_FRAME_H_
#define SHAPESPACE_OUTPUT_FRAME_H_

#include <Eigen/Core>

#include <shapespace/output/colour.h>
#include <shapespace/output/picture.h>
#include <shapespace/output/scene.h>
#include <shapespace/output/view.h>

namespace shapespace {

/// Linear light behind everything.
Colour Background();

/// The same for all frames of a strip.
struct Camera {
  Axes axes;
  Eigen::Vector2d centre;  ///< of the frame, along the first two axes
  double pixels_per_unit = 1;
  int width = 0, height = 0;  ///< of a frame, in pixels
  int samples = 1;            ///< per pixel and axis
};

/// Draws `scene` into the rectangle of `image` whose upper left pixel is (left, top), its front
/// faces in the colour of `role`. `show_values`: coloured by the scene's values instead, whose
/// scale ends at 1.
void DrawFrame(const Scene& scene, const Camera& camera, ShapeRole role, bool show_values, int left,
               int top, Image* image);

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_FRAME_H_
