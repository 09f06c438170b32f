#include <shapespace/output/detail/palette.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>

namespace shapespace::internal {
namespace {

// Colours are cut into boxes, each of which becomes the mean of its colours: a variant of Heckbert,
// "Color image quantization for frame buffer display" (SIGGRAPH 1982), in which the box with the
// greatest sum of squared differences is cut, at its mean.

struct CountedColour {
  Rgb colour;
  double count;
};
using Colours = std::vector<CountedColour>;

Rgb ColourAt(const RgbImage& image, size_t pixel) {
  return {image.pixels[3 * pixel], image.pixels[3 * pixel + 1], image.pixels[3 * pixel + 2]};
}

struct ColourBox {
  Colours::iterator begin, end;
  std::array<double, 3> mean;
  int axis = 0;       // along which colours differ most
  double spread = 0;  // the sum of squared differences from the mean along that axis

  ColourBox(Colours::iterator first, Colours::iterator last) : begin(first), end(last), mean() {
    double count = 0;
    std::array<double, 3> sum = {}, squares = {};
    for (auto it = first; it != last; ++it) {
      count += it->count;
      for (int c = 0; c < 3; ++c) {
        sum[c] += it->count * it->colour[c];
        squares[c] += it->count * it->colour[c] * it->colour[c];
      }
    }
    for (int c = 0; c < 3; ++c) {
      mean[c] = sum[c] / count;
      const double along = squares[c] - sum[c] * mean[c];
      if (std::distance(first, last) > 1 && along > spread) {
        axis = c;
        spread = along;
      }
    }
  }
};

int SquaredDistance(const Rgb& a, const Rgb& b) {
  int sum = 0;
  for (int c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

int Nearest(const Rgb& colour, const std::vector<Rgb>& colours) {
  int best = 0, least = std::numeric_limits<int>::max();
  for (size_t i = 0; i < colours.size(); ++i) {
    const int distance = SquaredDistance(colour, colours[i]);
    if (distance >= least) continue;
    least = distance;
    best = static_cast<int>(i);
  }
  return best;
}

std::vector<Rgb> CutColours(Colours colours, int most) {
  std::vector<ColourBox> boxes = {ColourBox(colours.begin(), colours.end())};
  while (static_cast<int>(boxes.size()) < most) {
    const auto widest = std::max_element(
        boxes.begin(), boxes.end(),
        [](const ColourBox& a, const ColourBox& b) { return a.spread < b.spread; });
    if (widest->spread <= 0) break;
    const ColourBox box = *widest;
    const auto middle = std::partition(box.begin, box.end, [&](const CountedColour& c) {
      return c.colour[box.axis] <= box.mean[box.axis];
    });
    *widest = ColourBox(box.begin, middle);
    boxes.emplace_back(middle, box.end);
  }
  std::vector<Rgb> result;
  for (const ColourBox& box : boxes) {
    Rgb& colour = result.emplace_back();
    for (int c = 0; c < 3; ++c) colour[c] = static_cast<unsigned char>(std::lround(box.mean[c]));
  }
  return result;
}

}  // namespace

std::optional<Palette> ExactPalette(const std::vector<RgbImage>& pictures, int most) {
  Palette palette;
  std::map<Rgb, unsigned char> numbers;
  for (const RgbImage& picture : pictures) {
    std::vector<unsigned char>& pixels = palette.pixels.emplace_back();
    for (size_t i = 0; 3 * i < picture.pixels.size(); ++i) {
      const auto [entry, is_new] =
          numbers.emplace(ColourAt(picture, i), static_cast<unsigned char>(numbers.size()));
      if (is_new) {
        if (static_cast<int>(numbers.size()) > most) return {};
        palette.colours.push_back(entry->first);
      }
      pixels.push_back(entry->second);
    }
  }
  return palette;
}

Palette MakePalette(const std::vector<RgbImage>& pictures, int most) {
  if (std::optional<Palette> exact = ExactPalette(pictures, most)) return *std::move(exact);
  std::map<Rgb, double> counts;
  for (const RgbImage& picture : pictures) {
    for (size_t i = 0; 3 * i < picture.pixels.size(); ++i) ++counts[ColourAt(picture, i)];
  }
  Colours colours;
  for (const auto& [colour, count] : counts) colours.push_back({colour, count});
  Palette palette;
  palette.colours = CutColours(std::move(colours), most);
  std::map<Rgb, unsigned char> numbers;
  for (const auto& [colour, count] : counts) {
    numbers[colour] = static_cast<unsigned char>(Nearest(colour, palette.colours));
  }
  for (const RgbImage& picture : pictures) {
    std::vector<unsigned char>& pixels = palette.pixels.emplace_back();
    for (size_t i = 0; 3 * i < picture.pixels.size(); ++i) {
      pixels.push_back(numbers.at(ColourAt(picture, i)));
    }
  }
  return palette;
}

}  // namespace shapespace::internal
