#ifndef SHAPESPACE_FILES_INTERNAL_TINYGLTF_H_
#define SHAPESPACE_FILES_INTERNAL_TINYGLTF_H_

// The glTF library without its image support. The macros defined here change its classes, so it
// must not be included in any other way.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#include <nlohmann/json.hpp>

#include <tiny_gltf.h>

#endif  // SHAPESPACE_FILES_INTERNAL_TINYGLTF_H_
