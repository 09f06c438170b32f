#ifndef SHAPESPACE_OUTPUT_DETAIL_MATERIALS_H_
#define SHAPESPACE_OUTPUT_DETAIL_MATERIALS_H_

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/appearance.h>

// Materials of OBJ, and their textures.

namespace shapespace::internal {

/// A material of a material library, as far as outputs can show it.
struct Material {
  Eigen::Vector3d colour = Eigen::Vector3d::Ones();  ///< `Kd`: red, green and blue in sRGB, 0 .. 1
  double opacity = 1;                                ///< `d`, or 1 - `Tr`
  std::string texture;  ///< `map_Kd`: the image's file, which may not exist, or lie outside
                        ///< of the folder; empty for none
};

/// Finds the materials of an appearance in its libraries, in the order of their names. Materials
/// that no library contains are empty. Libraries that cannot be read, or lie outside of
/// `Appearance::own_folder` unless `allow_outside_files`, and statements in them that cannot be
/// parsed, are reported as sentences in `warnings`.
std::vector<std::optional<Material>> ReadMaterials(const Appearance& appearance,
                                                   bool allow_outside_files,
                                                   std::vector<std::string>* warnings);

/// An image file as it is.
struct TextureImage {
  std::string type;  ///< image/png or image/jpeg, the formats that glTF and browsers read
  std::string bytes;
};

/// Reads the image of a texture. Nothing, and a sentence in `warnings`, if it cannot be read, is of
/// another format, or lies outside of `Appearance::own_folder` unless `allow_outside_files`.
std::optional<TextureImage> ReadTexture(const std::string& file, const Appearance& appearance,
                                        bool allow_outside_files,
                                        std::vector<std::string>* warnings);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_MATERIALS_H_
