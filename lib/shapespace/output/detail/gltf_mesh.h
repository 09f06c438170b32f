#ifndef SHAPESPACE_OUTPUT_DETAIL_GLTF_MESH_H_
#define SHAPESPACE_OUTPUT_DETAIL_GLTF_MESH_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/files/internal/tinygltf.h>
#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// What the mesh of a glTF file shows.
struct GltfBody {
  const Connectivity& connectivity;
  const std::vector<Shape>& shapes;  ///< the mesh itself, and its morph targets
  const Appearance& appearance;
  /// Red, green, blue (and opacity) of each vertex, in linear light; none if they have no colours.
  const Eigen::MatrixXf& colours;
  bool allow_outside_files = false;  ///< as in `GltfOptions`
};

/// Makes the first mesh of `model`: vertices relative to `origin`, in the order of the
/// connectivity, and at seams of textures copies of them after all others; triangles with a
/// primitive for each material, or a graph's lines. Returns for each vertex of the file that of the
/// connectivity. `file` is used in messages, and sentences about what cannot be shown are appended
/// to `warnings`.
/// \throw MeshError if single precision cannot hold the shapes or texture coordinates, or the file
///        would exceed the limit of the format.
std::vector<int> AddGltfMesh(const std::string& file, const GltfBody& body,
                             const Eigen::Vector3d& origin, tinygltf::Model* model,
                             std::vector<std::string>* warnings);

/// The colour of each vertex's group (`GltfOptions::groups`), in linear light.
Eigen::Matrix3Xf GroupColours(const Eigen::VectorXi& groups);

/// Converts sRGB, with opacities in a fourth row, to linear light.
Eigen::MatrixXf LinearColours(const Eigen::MatrixXd& colours);

/// The middle of a shape's bounding box.
Eigen::Vector3d MiddleOf(const Shape& shape);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_GLTF_MESH_H_
