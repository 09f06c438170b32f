#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <ostream>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/output/detail/palette.h>
#include <shapespace/output/detail/png_chunks.h>
#include <shapespace/output/picture.h>

// PNG as in https://www.w3.org/TR/png-3: colours of a palette where 256 are enough, else RGB.

namespace shapespace {
namespace {

using PngBytes = std::vector<unsigned char>;

constexpr int kMostColours = 256;

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
  using internal::PngPixels;
  const std::optional<internal::Palette> palette = internal::ExactPalette({image}, kMostColours);
  std::string bytes = internal::PngBeginning(
      image.width, image.height, palette ? PngPixels::kIndexed : PngPixels::kTrueColour);
  if (palette) internal::AppendPngChunk("PLTE", internal::PngColours(palette->colours), &bytes);
  const auto width = static_cast<size_t>(image.width);
  internal::AppendPngChunk(
      "IDAT",
      internal::CompressedPngRows(palette ? internal::UnfilteredPngRows(palette->pixels[0], width)
                                          : Filtered(image.pixels, 3 * width, 3)),
      &bytes);
  internal::AppendPngChunk("IEND", "", &bytes);
  return bytes;
}

void WritePng(const std::string& file, const RgbImage& image) {
  const std::string bytes = EncodePng(image);
  internal::WriteFileAtomically(file, [&](std::ostream& stream) { stream << bytes; });
}

}  // namespace shapespace
