#ifndef SHAPESPACE_OUTPUT_GLTF_H_
#define SHAPESPACE_OUTPUT_GLTF_H_

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/path/path.h>

namespace shapespace {

enum class GltfPlayback {
  kAutomatic,  ///< `kLoop` if the motion ends where it begins, else `kThereAndBack`
  /// From the first shape to the last and back in `duration`, for players that repeat the
  /// animation. Each of the two is held for a tenth of the duration, the first shape half of it at
  /// the beginning and half at the end.
  kThereAndBack,
  kLoop,  ///< From the first shape to the last, and again from the first
  kOnce,  ///< From the first shape to the last, which is held for the last tenth of the duration
};

struct GltfOptions {
  double duration = 4;  ///< seconds, holds included; 0.1 .. 3600
  double fps = 0;       ///< shapes per second instead of `duration`: .01 .. 1000; 0: off
  GltfPlayback playback = GltfPlayback::kAutomatic;

  /// Slow at both ends: the shape at share t of the path is shown after share tau of the time, with
  /// t = (1 - cos(pi tau)) / 2. Otherwise tau = t.
  bool ease = false;

  /// The user's upward axis, 'y' or 'z'. glTF's is y: for 'z' the node rotates the shapes.
  char up = 'y';
  double unit = 1;  ///< metres in one of the user's units (.001: millimetres), 1e-12 .. 1e12

  /// Colours every vertex by its largest deviation (`EdgeDeviation`) anywhere on the path. The
  /// colours are constant in time, because few viewers can animate colours.
  bool colour_by_deviation = false;
  Shape reference;  ///< for the deviation, in the metric's unit; empty: the first shape

  /// Group of each vertex, such as its rigid part, shown by colours; grey if negative. Empty: none.
  /// Cannot be combined with the deviation.
  Eigen::VectorXi groups;

  /// Read material libraries and textures from outside of the folder of the mesh, or `.path`, that
  /// names them too (`Appearance::own_folder`): for files that are trusted, because the textures
  /// become part of the glb. Otherwise those outside are left out, with a warning.
  bool allow_outside_files = false;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

struct GltfSummary {
  int keys = 0;             ///< shapes in the file
  bool subsampled = false;  ///< whether the path has more shapes than that
  size_t bytes = 0;         ///< size of the file
  double colour_end = 0;    ///< deviation at the end of the colour scale (.01 is one per cent), if
                            ///< shown
  std::vector<std::string> warnings;  ///< sentences: what of the appearance could not be shown
};

/// Writes the path as a binary glTF 2.0 file (.glb), an animation for browsers, Blender and others:
/// the first shape as placed by the path, and up to 31 others as morph targets, at times
/// proportional to the path's parameters. If there are more than 32 shapes, 32 are selected, evenly
/// spaced, including the poses and the ends. A path of one shape becomes a file without animation.
///
/// Vertices are the path's, in its order, in the user's unit, relative to the centre of the first
/// shape, which is the node's translation, because single precision is not accurate enough far from
/// the origin. Where a texture has seams the format needs copies of vertices, which follow after
/// all others.
///
/// Unless the options specify other colours, the path's appearance is shown: texture coordinates;
/// the colours, opacities and textures (PNG and JPEG, embedded; the colour of a material with a
/// texture is white) of its material libraries, with one primitive per material; and vertex
/// colours, which are multiplied with the material's. Colours are interpreted as sRGB. There are
/// warnings for libraries or textures that cannot be read, or may not.
///
/// Normals are smooth, weighted by area, also across single sharp edges, which would need further
/// vertices. Polyhedra and folded paper, most of whose edges are sharp, have no normals and are
/// therefore shaded flat. Graphs become lines along their segments. `asset.extras` contains the
/// metric, the number of shapes, the provenance and the end of the colour scale.
///
/// The file is written completely or not at all.
/// \throw InvalidOptions; FileError if it cannot be written; MeshError if there is no shape, if one
///        is not finite or has the wrong number of vertices, if the parameters do not increase, if
///        the shapes are too small or too large for single precision, or if the file would exceed 4
///        GB, the limit of the format.
GltfSummary WriteGltf(const std::string& file, const Path& path, const GltfOptions& options = {});

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_GLTF_H_
