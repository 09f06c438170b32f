#ifndef SHAPESPACE_OUTPUT_USD_H_
#define SHAPESPACE_OUTPUT_USD_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/path/path.h>

namespace shapespace {

struct UsdOptions {
  double fps = 24;  ///< time codes, and so shapes of an evenly spaced path, per second: .01 .. 1000
  char up = 'y';    ///< the user's upward axis, 'y' or 'z'
  double unit = 1;  ///< metres in one of the user's units (.001: millimetres), 1e-12 .. 1e12

  /// Red, green and blue of every vertex, 3 x m from 0 to 1 in sRGB: one matrix for all shapes, or
  /// one for each. Empty: the appearance of the path.
  std::vector<Eigen::MatrixXd> colours;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// Writes the path as a layer of Universal Scene Description in text form (.usda): one mesh of the
/// path's polygons, whose points have a time sample for each shape. The first shape has the time
/// code 0 and the last one the number of shapes less one; times are proportional to the path's
/// parameters. Positions are in the user's frame and unit, in single precision and relative to the
/// centre of the first shape, which is the translation of the transform above the mesh. Normals are
/// left to the reader, and the mesh is not subdivided.
///
/// Of the appearance, vertex colours (`displayColor`, `displayOpacity`) and texture coordinates
/// (`st`) are kept. With `UsdOptions::colours`, those are shown instead. The file is written
/// completely or not at all.
/// \return sentences about what the file does not hold.
/// \throw InvalidOptions; FileError if the name does not end in .usda or the file cannot be
/// written;
///        MeshError if the path is invalid, has no polygons, or has coordinates that would change
///        by more than a ten-thousandth of their shape's diagonal.
std::vector<std::string> WriteUsd(const std::string& file, const Path& path,
                                  const UsdOptions& options = {});

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_USD_H_
