#include <shapespace/output/film.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_GIF
#include <stb_image.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <numeric>

#include <zlib.h>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "mesh/files.h"
#include "support/message_of.h"

// Films are read back by stb_image, and the frames of an animated PNG one by one.

namespace shapespace {
namespace {

using Bytes = std::vector<unsigned char>;

struct Shown {
  std::vector<Bytes> pictures;  // RGB, as seen
  std::vector<int> hundredths;

  int Hundredths() const { return std::accumulate(hundredths.begin(), hundredths.end(), 0); }
};

Bytes WithoutAlpha(const unsigned char* rgba, size_t pixels) {
  Bytes rgb;
  for (size_t i = 0; i < pixels; ++i) rgb.insert(rgb.end(), rgba + 4 * i, rgba + 4 * i + 3);
  return rgb;
}

Shown ReadGif(const std::string& gif) {
  int* delays = nullptr;
  int width, height, frames, channels;
  const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
      stbi_load_gif_from_memory(reinterpret_cast<const stbi_uc*>(gif.data()),
                                static_cast<int>(gif.size()), &delays, &width, &height, &frames,
                                &channels, 4),
      stbi_image_free);
  Shown shown;
  if (decoded == nullptr) {
    ADD_FAILURE() << stbi_failure_reason();
    return shown;
  }
  const size_t pixels = static_cast<size_t>(width) * height;
  for (int i = 0; i < frames; ++i) {
    shown.pictures.push_back(WithoutAlpha(decoded.get() + 4 * pixels * i, pixels));
    shown.hundredths.push_back(delays[i] / 10);
  }
  stbi_image_free(delays);
  return shown;
}

std::uint32_t Number(const std::string& bytes, size_t at, size_t size = 4) {
  std::uint32_t value = 0;
  for (size_t i = 0; i < size; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

struct Chunk {
  std::string name, data;
};

std::vector<Chunk> ChunksOfApng(const std::string& png) {
  std::vector<Chunk> chunks;
  for (size_t at = 8; at + 12 <= png.size();) {
    const size_t size = Number(png, at);
    chunks.push_back({png.substr(at + 4, 4), png.substr(at + 8, size)});
    EXPECT_EQ(Number(png, at + 8 + size),
              crc32(0, reinterpret_cast<const Bytef*>(&png[at + 4]), static_cast<uInt>(size + 4)));
    at += 12 + size;
  }
  return chunks;
}

std::string FileOf(const std::vector<Chunk>& chunks) {
  std::string file = "\x89PNG\r\n\x1a\n";
  const auto append = [](std::uint32_t number, std::string* bytes) {
    for (int shift = 24; shift >= 0; shift -= 8) *bytes += static_cast<char>(number >> shift);
  };
  for (const Chunk& chunk : chunks) {
    append(static_cast<std::uint32_t>(chunk.data.size()), &file);
    const std::string content = chunk.name + chunk.data;
    file += content;
    append(
        crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size())),
        &file);
  }
  return file;
}

// Puts each frame over what is seen, where it is not transparent.
Shown ReadApng(const std::string& apng) {
  Shown shown;
  Chunk header, colours, transparency;
  std::string control;
  std::uint32_t number = 0;
  Bytes canvas;
  int canvas_width = 0;
  for (const Chunk& chunk : ChunksOfApng(apng)) {
    if (chunk.name == "IHDR") header = chunk;
    if (chunk.name == "PLTE") colours = chunk;
    if (chunk.name == "tRNS") transparency = chunk;
    if (chunk.name == "fcTL") {
      EXPECT_EQ(Number(chunk.data, 0), number++);
      control = chunk.data;
      EXPECT_EQ(Number(control, 22, 2), 100u);
      EXPECT_EQ(control.substr(24), std::string("\0\1", 2));
    }
    if (chunk.name != "IDAT" && chunk.name != "fdAT") continue;
    if (chunk.name == "fdAT") {
      EXPECT_EQ(Number(chunk.data, 0), number++);
    }
    Chunk own_header = header;
    own_header.data.replace(0, 8, control.substr(4, 8));
    const std::string file =
        FileOf({own_header,
                colours,
                transparency,
                {"IDAT", chunk.name == "IDAT" ? chunk.data : chunk.data.substr(4)},
                {"IEND", ""}});
    int width, height, channels;
    const std::unique_ptr<stbi_uc, void (*)(void*)> frame(
        stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(file.data()),
                              static_cast<int>(file.size()), &width, &height, &channels, 4),
        stbi_image_free);
    if (frame == nullptr) {
      ADD_FAILURE() << stbi_failure_reason();
      return shown;
    }
    if (canvas.empty()) {
      canvas_width = width;
      canvas.resize(3 * static_cast<size_t>(width) * height);
    }
    const auto left = static_cast<int>(Number(control, 12)),
               top = static_cast<int>(Number(control, 16));
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const stbi_uc* pixel = frame.get() + 4 * (static_cast<size_t>(y) * width + x);
        if (pixel[3] == 0) continue;
        std::copy_n(pixel, 3,
                    &canvas.at(3 * (static_cast<size_t>(top + y) * canvas_width + left + x)));
      }
    }
    shown.pictures.push_back(canvas);
    shown.hundredths.push_back(static_cast<int>(Number(control, 20, 2)));
  }
  return shown;
}

// Random colours, so many in all.
RgbImage Speckled(int width, int height, unsigned colours, unsigned seed = 1) {
  RgbImage image{width, height, {}};
  unsigned state = seed;
  for (int i = 0; i < width * height; ++i) {
    state = 1664525 * state + 1013904223;
    const unsigned colour = (state >> 8) % colours;
    for (const unsigned channel : {colour & 255, 3 * colour & 255, colour >> 3 & 255}) {
      image.pixels.push_back(static_cast<unsigned char>(channel));
    }
  }
  return image;
}

// A square of another colour at (x, y).
RgbImage WithSquare(RgbImage image, int x, int y) {
  for (int row = y; row < y + 5; ++row) {
    for (int column = x; column < x + 5; ++column) {
      image.pixels[3 * (static_cast<size_t>(row) * image.width + column)] = 251;
    }
  }
  return image;
}

Film Squares() {
  Film film;
  const RgbImage ground = Speckled(61, 43, 90);
  film.pictures = {ground, WithSquare(ground, 0, 0), WithSquare(ground, 56, 38),
                   WithSquare(ground, 20, 9)};
  film.order = {0, 1, 2, 3, 2, 1};
  film.seconds = {.5, .04, .05, 1, .05, .04};
  return film;
}

void ExpectShows(const Shown& shown, const Film& film) {
  ASSERT_EQ(shown.pictures.size(), film.order.size());
  for (size_t i = 0; i < film.order.size(); ++i) {
    EXPECT_EQ(shown.pictures[i], film.pictures[film.order[i]].pixels) << i;
    EXPECT_EQ(shown.hundredths[i], std::lround(100 * film.seconds[i])) << i;
  }
}

TEST(FilmTest, OtherProgramsSeeItsPicturesInOrder) {
  for (const unsigned colours : {1u, 2u, 90u, 255u}) {
    Film film = Squares();
    film.pictures[0] = Speckled(61, 43, colours);
    film.pictures[3] = WithSquare(film.pictures[0], 20, 9);
    if (colours == 255) {
      film.pictures = {film.pictures[0], Speckled(61, 43, 255, 2)};
      film.order = {0, 1, 0, 1, 0, 1};
    }
    ExpectShows(ReadGif(EncodeGif(film)), film);
    ExpectShows(ReadApng(EncodeApng(film)), film);
  }
}

TEST(FilmTest, ProgramsWithoutAnimationsSeeTheFirstPicture) {
  const Film film = Squares();
  const std::string apng = EncodeApng(film);
  int width, height, channels;
  const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(apng.data()),
                            static_cast<int>(apng.size()), &width, &height, &channels, 3),
      stbi_image_free);
  ASSERT_NE(decoded, nullptr);
  EXPECT_TRUE(
      std::equal(film.pictures[0].pixels.begin(), film.pictures[0].pixels.end(), decoded.get()));
}

TEST(FilmTest, SaysWhetherItRepeats) {
  Film film = Squares();
  const auto plays = [&] {
    for (const Chunk& chunk : ChunksOfApng(EncodeApng(film))) {
      if (chunk.name == "acTL") {
        EXPECT_EQ(Number(chunk.data, 0), film.order.size());
        return Number(chunk.data, 4);
      }
    }
    return 99u;
  };
  const auto forever = [&] {
    return EncodeGif(film).find(std::string("NETSCAPE2.0\x03\x01\0\0", 15)) != std::string::npos;
  };
  EXPECT_EQ(plays(), 0u);
  EXPECT_TRUE(forever());
  film.repeats = false;
  EXPECT_EQ(plays(), 1u);
  EXPECT_FALSE(forever());
}

// A third of a tenth of a second is no whole number of hundredths.
TEST(FilmTest, TheSumOfTimesIsRight) {
  Film film = Squares();
  film.order.clear();
  for (int i = 0; i < 30; ++i) film.order.push_back(i % 4);
  film.seconds.assign(30, 1.0 / 30);
  EXPECT_EQ(ReadGif(EncodeGif(film)).Hundredths(), 100);
  EXPECT_EQ(ReadApng(EncodeApng(film)).Hundredths(), 100);
}

TEST(FilmTest, APictureThatStaysIsStoredOnce) {
  Film film = Squares();
  film.order = {0, 0, 1, 1, 1, 0};
  film.seconds.assign(6, .1);
  for (const Shown& shown : {ReadGif(EncodeGif(film)), ReadApng(EncodeApng(film))}) {
    EXPECT_EQ(shown.hundredths, (std::vector<int>{20, 30, 10}));
  }
  // Longer than the formats can say of one picture.
  film.order.assign(3, 0);
  film.seconds.assign(3, 600);
  for (const Shown& shown : {ReadGif(EncodeGif(film)), ReadApng(EncodeApng(film))}) {
    EXPECT_EQ(shown.Hundredths(), 180000);
    for (const Bytes& picture : shown.pictures) EXPECT_EQ(picture, film.pictures[0].pixels);
  }
}

TEST(FilmTest, WhatDoesNotChangeTakesNoSpace) {
  Film still = Squares(), moving = still;
  still.order = {0};
  still.seconds = {1};
  moving.order.clear();
  for (int i = 0; i < 20; ++i) moving.order.push_back(i % 4);
  moving.seconds.assign(20, .04);
  EXPECT_LT(EncodeGif(moving).size(), 4 * EncodeGif(still).size());
  EXPECT_LT(EncodeApng(moving).size(), 4 * EncodeApng(still).size());
}

// Sixteen thousand colours become 255, of which one is near each.
TEST(FilmTest, ManyColoursAreNearlyTheSame) {
  RgbImage image{128, 128, {}};
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      for (const int channel : {2 * x, 2 * y, 90}) {
        image.pixels.push_back(static_cast<unsigned char>(channel));
      }
    }
  }
  Film film;
  film.pictures = {image};
  film.order = {0};
  film.seconds = {1};
  const Shown gif = ReadGif(EncodeGif(film)), apng = ReadApng(EncodeApng(film));
  ASSERT_EQ(gif.pictures.size(), 1u);
  EXPECT_EQ(gif.pictures, apng.pictures);
  double squares = 0;
  int largest = 0;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    const int error = gif.pictures[0][i] - image.pixels[i];
    squares += error * error;
    largest = std::max(largest, std::abs(error));
  }
  // 255 squares of equal size would have sides of 16, and errors of at most 8.
  EXPECT_LT(std::sqrt(squares / (128 * 128)), 16 / std::sqrt(6.0) * 1.2);
  EXPECT_LE(largest, 20);
}

TEST(FilmTest, WhatIsNoFilmIsRefused) {
  const auto message = [](const std::function<void(Film*)>& change) {
    Film film = Squares();
    change(&film);
    const auto encode = [&] { EncodeApng(film); };
    EXPECT_THROW(EncodeGif(film), InvalidOptions);
    return testing::MessageOf<InvalidOptions>(encode);
  };
  const auto expect = [&](const std::string& field, const std::function<void(Film*)>& change) {
    EXPECT_NE(message(change).find(field), std::string::npos) << message(change);
  };
  expect("pictures", [](Film* film) { film->pictures.clear(); });
  expect("pictures", [](Film* film) { film->pictures[2].pixels.pop_back(); });
  expect("number 3", [](Film* film) { film->pictures[3] = Speckled(61, 42, 3); });
  expect("pictures", [](Film* film) { film->pictures.assign(4, RgbImage()); });
  expect("order", [](Film* film) { film->order.clear(); });
  expect("order", [](Film* film) { film->order[3] = 4; });
  expect("order", [](Film* film) { film->order[3] = -1; });
  expect("seconds", [](Film* film) { film->seconds.pop_back(); });
  expect("seconds", [](Film* film) { film->seconds[1] = 0; });
  expect("seconds", [](Film* film) { film->seconds[1] = 601; });
}

TEST(FilmTest, AGifHasAtMostSoManyPixels) {
  Film film;
  film.pictures = {Speckled(65536, 1, 2)};
  film.order = {0};
  film.seconds = {1};
  EXPECT_THROW(EncodeGif(film), InvalidOptions);
  ExpectShows(ReadApng(EncodeApng(film)), film);
  film.pictures = {Speckled(65535, 1, 2)};
  ExpectShows(ReadGif(EncodeGif(film)), film);
}

class WriteFilmTest : public testing::FilesTest {};

TEST_F(WriteFilmTest, TheExtensionIsTheFormat) {
  const Film film = Squares();
  WriteFilm(Path("a.GIF"), film);
  WriteFilm(Path("a.apng"), film);
  EXPECT_EQ(testing::Content(Path("a.GIF")), EncodeGif(film));
  EXPECT_EQ(testing::Content(Path("a.apng")), EncodeApng(film));
  const std::string message =
      testing::MessageOf<FileError>([&] { WriteFilm(Path("a.mp4"), film); });
  EXPECT_NE(message.find("a.mp4"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(Path("a.mp4")));
}

}  // namespace
}  // namespace shapespace
