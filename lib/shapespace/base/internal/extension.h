#ifndef SHAPESPACE_BASE_INTERNAL_EXTENSION_H_
#define SHAPESPACE_BASE_INTERNAL_EXTENSION_H_

#include <filesystem>
#include <string>

#include <shapespace/base/internal/text.h>

namespace shapespace::internal {

/// The extension of a file's name in small letters, with its dot: ".obj" of "a/b.OBJ". Empty if the
/// name has none.
inline std::string FileExtension(const std::string& file) {
  return InSmallLetters(std::filesystem::u8path(file).extension().u8string());
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_EXTENSION_H_
