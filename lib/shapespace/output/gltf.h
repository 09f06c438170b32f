#ifndef SHAPESPACE_OUTPUT_GLTF_H_
#define SHAPESPACE_OUTPUT_GLTF_H_

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/path/path.h>

namespace shapespace {

enum class GltfPlayback {
  /// From the first shape to the last and back, in `duration`: players that loop close the motion.
  /// Each of the two is held for a tenth of the duration; the first half at the beginning and half
  /// at the end.
  kThereAndBack,
  kLoop,  ///< From the first to the last, which follows the first where a motion ends as it began
  kOnce,  ///< From the first to the last, which is held for the last tenth of the duration
};

struct GltfOptions {
  double duration = 4;  ///< seconds, holds included; 0.1 .. 3600
  double fps = 0;       ///< shapes of the path a second instead of `duration`: .01 .. 1000; 0: off
  GltfPlayback playback = GltfPlayback::kThereAndBack;

  /// Slow at both ends: the shape at t of the way comes after a share tau of the time with
  /// t = (1 - cos(pi tau)) / 2. Otherwise tau = t.
  bool ease = false;

  /// The user's axis that points up, 'y' or 'z'. glTF's is y: for 'z' the node turns the shapes.
  char up = 'y';
  double unit = 1;  ///< metres in one of the user's units (.001: millimetres), 1e-12 .. 1e12

  /// Colours every vertex by the largest deviation (`EdgeDeviation`) that it has anywhere on the
  /// path. One colour for the whole time: few viewers can animate colours.
  bool colour_by_deviation = false;
  Shape reference;  ///< that it deviates from, in the metric's unit; empty: the first shape

  /// Group of each vertex, such as its rigid part: a colour each, grey where negative. Empty: none.
  /// Not together with the deviation.
  Eigen::VectorXi groups;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

struct GltfSummary {
  int keys = 0;             ///< shapes in the file
  bool subsampled = false;  ///< the path has more shapes than that
  size_t bytes = 0;         ///< size of the file
  double colour_end = 0;    ///< deviation that has the last colour (.01 is one per cent), if asked
  std::vector<std::string> warnings;  ///< sentences: what of the appearance could not be shown
};

/// Writes the path as a binary glTF 2.0 file (.glb), an animation that anything from browsers to
/// Blender plays: the first shape as placed by the path, and up to 31 others as morph targets, at
/// times proportional to the path's parameters. Of more than 32 shapes 32 are taken, evenly, with
/// the poses and the ends. A path of one shape becomes a still.
///
/// Vertices are the path's, in its order, in the user's unit, relative to the middle of the first
/// shape, which is the node's translation: far from the origin single precision would not do. Where
/// a texture has seams the format needs further vertices: copies, which stand after all of these.
///
/// Without other colours in the options the path's appearance is shown: texture coordinates; the
/// colours, opacities and textures (PNG and JPEG, embedded; one with a texture is white else) that
/// its material libraries describe, by one primitive a material; vertex colours, which colour what
/// is below them as a filter does. Colours are taken as sRGB. Libraries or textures that cannot be
/// read are warned of.
///
/// Normals are smooth, weighted by area, also across single sharp edges: leaving those sharp would
/// take further vertices. Polyhedra and folded paper, of which most edges are sharp, have no
/// normals and so are shaded flat. Graphs become lines along their segments. `asset.extras` tells
/// the metric, the number of shapes, the provenance and the end of the colour scale.
///
/// The file appears whole or not at all.
/// \throw InvalidOptions; FileError if it cannot be written; MeshError if there is no shape, if one
///        is not finite or has the wrong number of vertices, if the parameters do not rise, if the
///        shapes are smaller or larger than single precision can tell, or if the file would exceed
///        4 GB, the most that the format holds.
GltfSummary WriteGltf(const std::string& file, const Path& path, const GltfOptions& options = {});

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_GLTF_H_
