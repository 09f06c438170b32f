#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb_image.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <utility>

#include <zlib.h>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/output/picture.h>

#include "support/temporary_file.h"

namespace shapespace {
namespace {

using testing::TemporaryFile;

std::uint32_t BigEndian(const std::string& bytes, size_t at) {
  std::uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

// Checks lengths and check sums, which not every reader does. Returns the names of the chunks.
std::string ChunksOf(const std::string& png) {
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  std::string names;
  size_t at = 8;
  while (at + 12 <= png.size()) {
    const size_t size = BigEndian(png, at);
    if (at + 12 + size > png.size()) break;
    names += png.substr(at + 4, 4) + " ";
    EXPECT_EQ(BigEndian(png, at + 8 + size),
              crc32(0, reinterpret_cast<const Bytef*>(&png[at + 4]), static_cast<uInt>(size + 4)));
    at += 12 + size;
  }
  EXPECT_EQ(at, png.size());
  return names;
}

// What another reader finds in the file.
void ExpectDecodes(const std::string& png, const RgbImage& image) {
  int width, height, channels;
  const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(png.data()),
                            static_cast<int>(png.size()), &width, &height, &channels, 0),
      stbi_image_free);
  ASSERT_NE(decoded, nullptr) << stbi_failure_reason();
  EXPECT_EQ(width, image.width);
  EXPECT_EQ(height, image.height);
  EXPECT_EQ(channels, 3);
  EXPECT_TRUE(std::equal(image.pixels.begin(), image.pixels.end(), decoded.get()));
}

// Random colours, so many in all.
RgbImage Noise(int width, int height, int colours) {
  RgbImage image{width, height, {}};
  unsigned state = 1;
  const auto next = [&] { return (state = 1664525 * state + 1013904223) >> 8; };
  for (int i = 0; i < width * height; ++i) {
    const unsigned colour = i < colours ? i : next() % colours;
    for (const unsigned channel : {colour & 255, colour >> 8 & 255, 3 * colour & 255}) {
      image.pixels.push_back(static_cast<unsigned char>(channel));
    }
  }
  return image;
}

TEST(EncodePngTest, DecodesToTheSamePixels) {
  for (const int colours : {1, 2, 255, 256, 257, 5000}) {
    const RgbImage image = Noise(97, 83, colours);
    const std::string png = EncodePng(image);
    ExpectDecodes(png, image);
    EXPECT_EQ(ChunksOf(png), colours <= 256 ? "IHDR sRGB PLTE IDAT IEND " : "IHDR sRGB IDAT IEND ");
  }
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 300}, std::pair{300, 1}}) {
    ExpectDecodes(EncodePng(Noise(width, height, 1)), Noise(width, height, 1));
    ExpectDecodes(EncodePng(Noise(width, height, 300)), Noise(width, height, 300));
  }
}

TEST(EncodePngTest, IsSmallWhereColoursChangeSlowly) {
  RgbImage image{400, 300, {}};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (const int channel : {x + y, 2 * x + y, x + 3 * y}) {
        image.pixels.push_back(static_cast<unsigned char>(channel));
      }
    }
  }
  const std::string png = EncodePng(image);
  ExpectDecodes(png, image);
  // Differences from the pixel above are the same everywhere.
  EXPECT_LT(png.size(), image.pixels.size() / 100);
}

TEST(WritePngTest, WritesTheBytes) {
  const RgbImage image = Noise(37, 11, 300);
  const std::string file = TemporaryFile("round_trip.png");
  WritePng(file, image);
  std::ifstream stream(file, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), EncodePng(image));
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
