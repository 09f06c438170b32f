#include <shapespace/files/display_names.h>

#include <gtest/gtest.h>

namespace shapespace {
namespace {

using Names = std::vector<std::string>;

TEST(DisplayNamesTest, FilesLoseFolderAndExtensionOthersNothing) {
  EXPECT_EQ(DisplayNames({"/home/anna/cat/sit.obj", "../stand.002.GLB", "sit.001", "mouth/open"}),
            (Names{"sit", "stand.002", "sit.001", "mouth/open"}));
}

TEST(DisplayNamesTest, NoTwoAreEqual) {
  EXPECT_EQ(DisplayNames({"a/sit.obj", "b/sit.obj", "sit 2", "sit"}),
            (Names{"sit", "sit 2", "sit 2 2", "sit 3"}));
}

}  // namespace
}  // namespace shapespace
