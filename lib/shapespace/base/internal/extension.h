#ifndef SHAPESPACE_BASE_INTERNAL_EXTENSION_H_
#define SHAPESPACE_BASE_INTERNAL_EXTENSION_H_

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace shapespace::internal {

/// The extension of a file's name in small letters, with its dot: ".obj" of "a/b.OBJ". Empty if the
/// name has none.
inline std::string FileExtension(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_EXTENSION_H_
