#ifndef SHAPESPACE_OUTPUT_PICTURE_H_
#define SHAPESPACE_OUTPUT_PICTURE_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// What a shape is to its path; decides its colour.
enum class ShapeRole {
  kPose,          ///< given: blue
  kInserted,      ///< between poses: green
  kExtrapolated,  ///< beyond them: purple
};

/// A film strip: shapes side by side from one camera, drawn with Embree.
struct FilmStripOptions {
  /// Longer side of the largest shape's cell, in pixels, 16 .. 2048. Cells are as narrow or as low
  /// as the shapes allow, and wrap into rows when a strip would be wider than six times this.
  int frame_width = 320;
  /// 2 .. 1000; longer paths are subsampled, as evenly as both ends and the shapes of role kPose,
  /// which are kept, allow.
  int max_frames = 9;
  int samples = 3;  ///< per pixel and axis, 1 .. 16

  /// Where the eye is, seen from the body: (0, 0, 1) looks at it from +z. Zero: a three-quarter
  /// view chosen from the shapes.
  Eigen::Vector3d view = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::Zero();  ///< zero: +y or +z, whichever the shapes stand on

  /// Optional values per shape and vertex (.01 is one per cent; below 0 counts as 0), shown as
  /// colour with a legend in per cent; empty: plain. The scale ends at the 99th percentile of the
  /// values drawn, rounded up. With values, back faces are the same colour, darker.
  std::vector<Eigen::VectorXd> values;
  std::string legend;  ///< what `values` or `groups` are, e.g. "edge deviation"; ASCII, at most 120
                       ///< characters

  /// Optional group of each vertex, such as its rigid part, shown as a colour each with a legend
  /// that counts from 1; negative: none, grey. Empty: plain. Not together with `values`.
  Eigen::VectorXi groups;

  /// Optional mark of each vertex, such as what holds it: 1 dark, 2 red, else none; around a vertex
  /// a spot large enough to see. Not seen where there are values or groups.
  Eigen::VectorXi marks;

  /// Per shape; empty: all are poses. Not seen where there are values or groups.
  std::vector<ShapeRole> roles;
  std::vector<std::string> labels;  ///< written under each shape, as `legend`; empty: none
  std::string title;                ///< a line above all, as `legend`; empty: none

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// 8-bit sRGB, row after row from the top, three bytes a pixel.
struct RgbImage {
  int width = 0, height = 0;
  std::vector<unsigned char> pixels;
};

/// Draws `shapes` (all of `connectivity`, any units) smoothly shaded on a light background. Back
/// faces have another colour, so that inversions show. Graphs are drawn as tubes along their edges.
/// The same view, scale and light for every shape; each is centred in its frame by its bounding
/// box, so that frames keep the shapes' motion only in orientation and form.
/// The picture does not depend on the number of threads.
/// \throw InvalidOptions, also if the picture would have more than 100 million pixels; MeshError if
///        there is no shape, or one has another number of vertices or is not finite.
RgbImage RenderFilmStrip(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                         const FilmStripOptions& options = {});

/// The bytes of a PNG file.
/// \throw InvalidOptions if `image` is empty or its size is not that of its pixels.
std::string EncodePng(const RgbImage& image);

/// Writes it; the file appears whole or not at all.
/// \throw FileError; InvalidOptions as above.
void WritePng(const std::string& file, const RgbImage& image);

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_PICTURE_H_
