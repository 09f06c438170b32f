#ifndef SHAPESPACE_OUTPUT_DETAIL_GLTF_FILE_H_
#define SHAPESPACE_OUTPUT_DETAIL_GLTF_FILE_H_

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <shapespace/files/internal/tinygltf.h>
#include <shapespace/output/gltf.h>

namespace shapespace::internal {

/// The times of `PlaybackMoments` in single precision, which increase although parameters may
/// differ by less than that resolves.
Eigen::RowVectorXf TimesOf(const std::vector<std::pair<double, double>>& moments);

/// A node that transforms the user's coordinates relative to `origin` to glTF's, in metres and with
/// y up.
tinygltf::Node PlacedNode(const Eigen::Vector3d& origin, const GltfOptions& options);

/// File names in a provenance may contain any bytes; JSON may not.
std::string AsUtf8(const std::string& text);

/// Writes the model, completely or not at all, with `extras` of its asset. Returns the file's size.
size_t WriteGltfModel(const std::string& file, const tinygltf::Value::Object& extras,
                      tinygltf::Model* model);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_GLTF_FILE_H_
