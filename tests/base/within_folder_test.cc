#include <shapespace/base/internal/within_folder.h>

#include "mesh/files.h"

namespace shapespace {
namespace {

using WithinFolderTest = testing::FilesTest;
using internal::IsWithinFolder;

TEST_F(WithinFolderTest, FollowsDotsAndLinks) {
  std::filesystem::create_directories(Path("home/below"));
  std::filesystem::create_directories(Path("homely"));
  File("secret", "x");
  std::filesystem::create_symlink(Path("secret"), Path("home/link"));
  std::filesystem::create_directory_symlink(Path("homely"), Path("home/way"));
  std::filesystem::create_symlink(Path("home/below/file"), Path("home/inner"));
  const std::string home = Path("home");
  for (const char* inside : {"home/file", "home/below/file", "home/below/../file", "home/inner",
                             "homely/../home/file"}) {
    EXPECT_TRUE(IsWithinFolder(home, Path(inside))) << inside;
    EXPECT_TRUE(IsWithinFolder(home + "/", Path(inside))) << inside;
  }
  for (const char* outside : {"secret", "home/../secret", "homely/file", "home/link",
                              "home/way/file", "home/below/../../secret"}) {
    EXPECT_FALSE(IsWithinFolder(home, Path(outside))) << outside;
  }
  EXPECT_TRUE(IsWithinFolder("", "file")) << "of the current folder";
  EXPECT_FALSE(IsWithinFolder("", "../file"));
}

}  // namespace
}  // namespace shapespace
