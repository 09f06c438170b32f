#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <ostream>
#include <string_view>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/output/picture.h>

// PNG as in https://www.w3.org/TR/png-3: colours of a palette where 256 are enough, else RGB.

namespace shapespace {
namespace {

using internal::AppendBigEndian;
using PngBytes = std::vector<unsigned char>;

constexpr int kMostColours = 256;
constexpr unsigned char kTrueColour = 2, kIndexed = 3;  // kinds of pixels, as the format has them

void AppendChunk(const std::string& name, std::string_view data, std::string* out) {
  AppendBigEndian(static_cast<std::uint32_t>(data.size()), out);
  const std::string content = name + std::string(data);
  *out += content;
  AppendBigEndian(static_cast<std::uint32_t>(
                      crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size())),
                  out);
}

// The colours of a picture as the bytes of a palette, and the number of each pixel's colour.
struct Palette {
  std::string colours;
  PngBytes pixels;
};

std::optional<Palette> PaletteOf(const RgbImage& image) {
  Palette palette;
  std::map<std::array<unsigned char, 3>, unsigned char> numbers;
  for (size_t i = 0; i < image.pixels.size(); i += 3) {
    const std::array<unsigned char, 3> colour = {image.pixels[i], image.pixels[i + 1],
                                                 image.pixels[i + 2]};
    const auto [entry, is_new] =
        numbers.emplace(colour, static_cast<unsigned char>(numbers.size()));
    if (is_new) {
      if (numbers.size() > kMostColours) return {};
      palette.colours.append(colour.begin(), colour.end());
    }
    palette.pixels.push_back(entry->second);
  }
  return palette;
}

// What the byte `left` + `up` - `corner` is nearest to (the filter that is Paeth's).
int Paeth(int left, int up, int corner) {
  const int guess = left + up - corner;
  const int a = std::abs(guess - left), b = std::abs(guess - up), c = std::abs(guess - corner);
  return a <= b && a <= c ? left : b <= c ? up : corner;
}

// Rows of `row_bytes` bytes, each preceded by the number of its filter and filtered by it: the one
// of the five whose differences have the least sum of absolute values, as the standard recommends
// for true colour.
PngBytes Filtered(const PngBytes& pixels, size_t row_bytes, size_t pixel_bytes) {
  PngBytes filtered, best, trial(row_bytes);
  filtered.reserve(pixels.size() + pixels.size() / row_bytes);
  const PngBytes zero(row_bytes, 0);
  for (size_t begin = 0; begin < pixels.size(); begin += row_bytes) {
    const unsigned char* row = &pixels[begin];
    const unsigned char* above = begin == 0 ? zero.data() : row - row_bytes;
    unsigned char best_filter = 0;
    std::int64_t best_sum = std::numeric_limits<std::int64_t>::max();
    for (unsigned char filter = 0; filter < 5; ++filter) {
      std::int64_t sum = 0;
      for (size_t i = 0; i < row_bytes; ++i) {
        const int left = i < pixel_bytes ? 0 : row[i - pixel_bytes];
        const int corner = i < pixel_bytes ? 0 : above[i - pixel_bytes];
        const int up = above[i];
        const std::array<int, 5> guesses = {0, left, up, (left + up) / 2, Paeth(left, up, corner)};
        trial[i] = static_cast<unsigned char>(row[i] - guesses[filter]);
        sum += std::min<int>(trial[i], 256 - trial[i]);
      }
      if (sum >= best_sum) continue;
      best_sum = sum;
      best_filter = filter;
      best = trial;
    }
    filtered.push_back(best_filter);
    filtered.insert(filtered.end(), best.begin(), best.end());
  }
  return filtered;
}

// Rows as they are, each preceded by the number of no filter: best for numbers of colours.
PngBytes Unfiltered(const PngBytes& pixels, size_t row_bytes) {
  PngBytes rows;
  rows.reserve(pixels.size() + pixels.size() / row_bytes);
  for (auto row = pixels.begin(); row != pixels.end(); row += static_cast<ptrdiff_t>(row_bytes)) {
    rows.push_back(0);
    rows.insert(rows.end(), row, row + static_cast<ptrdiff_t>(row_bytes));
  }
  return rows;
}

std::string Compressed(const PngBytes& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string compressed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(compressed.data()), &size, bytes.data(), bytes.size(),
                Z_BEST_COMPRESSION) != Z_OK) {
    throw InvalidOptions("image", "could not be compressed (out of memory?)");
  }
  compressed.resize(size);
  return compressed;
}

}  // namespace

std::string EncodePng(const RgbImage& image) {
  // Sizes in the file have 31 bits.
  if (image.pixels.size() >= static_cast<size_t>(std::numeric_limits<int>::max())) {
    throw InvalidOptions("image", "too large for a PNG");
  }
  if (image.width <= 0 || image.height <= 0 ||
      image.pixels.size() != 3 * static_cast<size_t>(image.width) * image.height) {
    throw InvalidOptions("image", std::to_string(image.pixels.size()) + " bytes are not " +
                                      std::to_string(image.width) + " x " +
                                      std::to_string(image.height) + " pixels of three");
  }
  const std::optional<Palette> palette = PaletteOf(image);
  std::string header;
  AppendBigEndian(static_cast<std::uint32_t>(image.width), &header);
  AppendBigEndian(static_cast<std::uint32_t>(image.height), &header);
  header += {8, static_cast<char>(palette ? kIndexed : kTrueColour), 0, 0, 0};
  std::string bytes = "\x89PNG\r\n\x1a\n";
  AppendChunk("IHDR", header, &bytes);
  AppendChunk("sRGB", std::string(1, '\0'), &bytes);
  if (palette) AppendChunk("PLTE", palette->colours, &bytes);
  const auto width = static_cast<size_t>(image.width);
  AppendChunk("IDAT",
              Compressed(palette ? Unfiltered(palette->pixels, width)
                                 : Filtered(image.pixels, 3 * width, 3)),
              &bytes);
  AppendChunk("IEND", "", &bytes);
  return bytes;
}

void WritePng(const std::string& file, const RgbImage& image) {
  const std::string bytes = EncodePng(image);
  internal::WriteFileAtomically(file, [&](std::ostream& stream) { stream << bytes; });
}

}  // namespace shapespace
