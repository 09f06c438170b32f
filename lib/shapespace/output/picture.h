#ifndef SHAPESPACE_OUTPUT_PICTURE_H_
#define SHAPESPACE_OUTPUT_PICTURE_H_

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// The role of a shape in its path; determines its colour.
enum class ShapeRole {
  kPose,          ///< given: blue
  kInserted,      ///< between poses: green
  kExtrapolated,  ///< beyond them: purple
};

/// Options of a film strip: shapes side by side, seen from one camera, drawn with Embree. Texts are
/// in UTF-8 and as large as the frames permit. They may have letters of Latin, Greek and Cyrillic
/// script and common signs; any other character shows as a box, and a byte that is not UTF-8 as the
/// replacement character.
struct FilmStripOptions {
  /// Longer side of the largest shape's cell, in pixels, 16 .. 2048. Cells are as narrow or as low
  /// as shapes and labels permit, and are arranged in rows if a strip would be wider than six times
  /// this. An em of the text is a sixteenth of it, and at least 12 pixels.
  int frame_width = 320;
  /// 2 .. 1000; of longer paths evenly spaced shapes are drawn, including both ends and the shapes
  /// of role kPose.
  int max_frames = 9;
  /// Shapes in a row, 0 .. 1000; 0: as many as such a strip holds.
  int columns = 0;
  int samples = 3;  ///< per pixel and axis, 1 .. 16

  /// Direction from the body to the eye: (0, 0, 1) looks at it from +z. Zero: a three-quarter view
  /// chosen from the shapes.
  Eigen::Vector3d view = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::Zero();  ///< zero: chosen from +y and +z

  /// Height of the ground along `up`, in the shapes' unit; none: each shape is in the middle of its
  /// cell. With a ground, a line is drawn at this height, and every cell shows the same part of the
  /// world from the side, so that shapes are where they are: a foot that stands is at the same
  /// place between the ticks of the line in every cell, and one that slides is not. Shapes are not
  /// moved. Motion towards the eye is not visible; `view` is horizontal, or is chosen.
  std::optional<double> ground_line;

  /// Optional values per shape and vertex (.01 is one per cent; negative values count as 0), shown
  /// as colours with a legend in per cent; empty: none. The scale ends at the 99th percentile of
  /// the values drawn, rounded up. With values, back faces have the same colour, darkened.
  std::vector<Eigen::VectorXd> values;
  std::string legend;  ///< meaning of `values` or `groups`, e.g. "edge deviation"; at most 120
                       ///< characters

  /// Optional group of each vertex, such as its rigid part, shown by colours with a legend that
  /// counts from 1, or that has its text alone where there are `numbers`; negative: none, grey.
  /// Empty: none. Cannot be combined with `values`.
  Eigen::VectorXi groups;

  /// Optional mark of each vertex: 1 is drawn dark, 2 red, 0 not at all; around a vertex it is a
  /// spot of visible size. Not drawn together with values or groups.
  Eigen::VectorXi marks;

  /// Optional number of each vertex, such as that of a marker, written beside the vertex where it
  /// is seen; 0: none.
  Eigen::VectorXi numbers;

  /// Per shape; empty: all are poses. Not visible with values or groups.
  std::vector<ShapeRole> roles;
  /// Written under each shape; what is wider than `frame_width` is cut off. Empty: none.
  std::vector<std::string> labels;
  std::string title;  ///< a line above the strip, at most 120 characters; empty: none

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// 8-bit sRGB, row after row from the top, three bytes a pixel.
struct RgbImage {
  int width = 0, height = 0;
  std::vector<unsigned char> pixels;
};

/// Draws `shapes` (all of `connectivity`, in any unit), smoothly shaded on a light background. Back
/// faces have another colour, so that inversions are visible. Graphs are drawn as tubes along their
/// edges. View, scale and light are the same for all shapes; each is centred in its frame by its
/// bounding box, so that translations are not visible, unless there is a ground line. The picture
/// does not depend on the number of threads.
/// \throw InvalidOptions, also if the picture would have more than 100 million pixels; MeshError if
///        there is no shape, or one has another number of vertices or is not finite.
RgbImage RenderFilmStrip(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                         const FilmStripOptions& options = {});

/// A picture of each shape, all of one size, for a film or a series of slides. They show the same
/// part of the world from one camera, so that shapes are where they are; the longer side of that
/// part is `frame_width` pixels. All shapes are drawn: `max_frames` and `columns` have no effect.
/// \throw as RenderFilmStrip, of all pictures together; InvalidOptions if shapes are so far
///        from each other that they would be as small as a pixel.
std::vector<RgbImage> RenderFilm(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                                 const FilmStripOptions& options = {});

/// The direction to the eye of such a film strip, a unit vector: to draw others from there, or from
/// the opposite side.
/// \throw as RenderFilmStrip.
Eigen::Vector3d FilmStripView(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                              const FilmStripOptions& options = {});

/// The bytes of a PNG file, with a palette if there are at most 256 colours.
/// \throw InvalidOptions if `image` is empty or its size is not that of its pixels.
std::string EncodePng(const RgbImage& image);

/// Writes it as a file, completely or not at all.
/// \throw FileError; InvalidOptions as above.
void WritePng(const std::string& file, const RgbImage& image);

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_PICTURE_H_
