#ifndef SHAPESPACE_OUTPUT_DETAIL_PALETTE_H_
#define SHAPESPACE_OUTPUT_DETAIL_PALETTE_H_

#include <array>
#include <optional>
#include <vector>

#include <shapespace/output/picture.h>

namespace shapespace::internal {

using Rgb = std::array<unsigned char, 3>;

/// Colours, and the number of the colour of each pixel.
struct Palette {
  std::vector<Rgb> colours;
  std::vector<std::vector<unsigned char>> pixels;  ///< of each picture
};

/// The colours of the pictures, in the order in which they appear; none if there are more than
/// `most`, 1 .. 256.
std::optional<Palette> ExactPalette(const std::vector<RgbImage>& pictures, int most);

/// The same, but if there are more, colours such that the sum of squared differences is small.
Palette MakePalette(const std::vector<RgbImage>& pictures, int most);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_PALETTE_H_
