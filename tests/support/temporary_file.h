#ifndef SHAPESPACE_TESTS_SUPPORT_TEMPORARY_FILE_H_
#define SHAPESPACE_TESTS_SUPPORT_TEMPORARY_FILE_H_

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace shapespace::testing {

/// The path of a file or folder with this name among temporary files; it is not created.
inline std::string TemporaryFile(const std::string& name) {
  return (std::filesystem::path(::testing::TempDir()) / name).string();
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_TEMPORARY_FILE_H_
