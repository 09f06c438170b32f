#ifndef SHAPESPACE_OUTPUT_PICTURE_H_
#define SHAPESPACE_OUTPUT_PICTURE_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// A film strip: shapes side by side from one camera, drawn with Embree.
struct FilmStripOptions {
  int frame_width = 320;  ///< pixels a shape, at most; the strip wraps into rows when it is long
  int max_frames = 9;     ///< longer paths are subsampled evenly, both ends kept
  int samples = 3;        ///< per pixel and axis
  /// Direction from which to look, towards the body; zero: a three-quarter view chosen from the
  /// shapes.
  Eigen::Vector3d view = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::Zero();  ///< zero: chosen with the view

  /// Optional value per shape and vertex, shown as colour with a legend in per cent; empty: plain.
  std::vector<Eigen::VectorXd> values;
  std::string legend;  ///< what `values` are, e.g. "edge deviation"

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// 8-bit RGB, row after row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<unsigned char> pixels;
};

/// Draws `shapes` (all of `connectivity`, any units) smoothly shaded on a light background. Back
/// faces have another colour, so that inversions show. Graphs are drawn as tubes along their edges.
/// The same view, scale and light for every shape; frames keep the shapes' motion relative to each
/// other only in orientation: each is centred in its frame.
/// \throw InvalidOptions, MeshError if a shape has another number of vertices or is not finite.
Image RenderFilmStrip(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                      const FilmStripOptions& options = {});

/// Writes a PNG; the file appears whole or not at all.
/// \throw FileError.
void WritePng(const std::string& file, const Image& image);

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_PICTURE_H_
