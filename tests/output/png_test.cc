#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb_image.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/output/picture.h>

#include "support/temporary_file.h"

namespace shapespace {
namespace {

using testing::TemporaryFile;

TEST(WritePngTest, RoundTrips) {
  RgbImage image{37, 11, std::vector<unsigned char>(3 * 37 * 11)};
  unsigned state = 1;
  for (unsigned char& byte : image.pixels) byte = (state = 1664525 * state + 1013904223) >> 24;
  const std::string file = TemporaryFile("round_trip.png");
  WritePng(file, image);
  int width, height, channels;
  const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
      stbi_load(file.c_str(), &width, &height, &channels, 0), stbi_image_free);
  ASSERT_NE(decoded, nullptr) << stbi_failure_reason();
  EXPECT_EQ(width, image.width);
  EXPECT_EQ(height, image.height);
  EXPECT_EQ(channels, 3);
  EXPECT_TRUE(std::equal(image.pixels.begin(), image.pixels.end(), decoded.get()));
  std::filesystem::remove(file);
}

TEST(WritePngTest, RefusesAnImageThatIsNone) {
  const std::string file = TemporaryFile("none.png");
  EXPECT_THROW(WritePng(file, RgbImage()), InvalidOptions);
  EXPECT_THROW(WritePng(file, RgbImage{2, 2, std::vector<unsigned char>(11)}), InvalidOptions);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(WritePngTest, NamesAFileThatCannotBeWritten) {
  const std::string blocker = TemporaryFile("blocker");
  std::ofstream(blocker) << "a file where a folder should be";
  try {
    WritePng(blocker + "/picture.png", RgbImage{1, 1, {0, 0, 0}});
    FAIL() << "wrote below a file";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("blocker/picture.png"), std::string::npos);
  }
  std::filesystem::remove(blocker);
}

}  // namespace
}  // namespace shapespace
