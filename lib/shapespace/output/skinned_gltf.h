#ifndef SHAPESPACE_OUTPUT_SKINNED_GLTF_H_
#define SHAPESPACE_OUTPUT_SKINNED_GLTF_H_

#include <cstddef>
#include <string>
#include <vector>

#include <shapespace/output/gltf.h>
#include <shapespace/output/skinned_path.h>

namespace shapespace {

struct SkinnedGltfOptions {
  /// Playback, unit, axis and appearance. Without colours by deviation: the shapes are not those of
  /// a path.
  GltfOptions gltf;

  /// Keys of a joint are left out where the interpolation of its others moves no point of the body
  /// at rest by more than this share of half the diagonal of its bounding box, relative to the
  /// joint's parent; 0 .. 0.1. With 0 only those are left out that change nothing.
  double key_error = 1e-4;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

struct SkinnedGltfSummary {
  int keys = 0;                       ///< of all joints' translations, rotations and scales
  int all_keys = 0;                   ///< the same if none had been left out
  size_t bytes = 0;                   ///< size of the file
  std::vector<std::string> warnings;  ///< sentences: what of the appearance could not be shown
};

/// Writes a motion given by bones as a binary glTF 2.0 file (.glb) with a skin, which engines,
/// browsers and Blender play: the rest pose as the mesh; a node for each joint, in the tree of the
/// joints, with translation, rotation and scale; inverse bind matrices; JOINTS_0 and WEIGHTS_0, and
/// JOINTS_1 and WEIGHTS_1 if vertices have more than four bones; and one animation, in which
/// rotations take the shorter way. Nodes rest in the rest pose.
///
/// Weights are 16-bit integers that sum to exactly 65535. A joint whose bone is scaled has a child
/// without children for the scale, which is the skin's joint, so that its scale does not shear the
/// bones behind it.
///
/// Vertices, their order, appearance, times and placement are as in `WriteGltf`; normals are those
/// of the rest pose, which players turn with the bones. `asset.extras` contains the numbers of
/// joints and shapes and the provenance.
///
/// The file is written completely or not at all.
/// \throw InvalidOptions; FileError if it cannot be written; MeshError if the path is not valid, or
///        as `WriteGltf`.
SkinnedGltfSummary WriteSkinnedGltf(const std::string& file, const SkinnedPath& path,
                                    const SkinnedGltfOptions& options = {});

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_SKINNED_GLTF_H_
