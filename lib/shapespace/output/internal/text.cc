#include <shapespace/output/internal/text.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <stb_easy_font.h>

#include <shapespace/base/error.h>
#include <shapespace/output/internal/frame.h>

namespace shapespace::internal {
namespace {

constexpr int kTextScale = 2;
constexpr int kFontRows = 12;  // including descenders
constexpr int kTextSamples = 4;
constexpr float kBlur = 0.5f, kCut = 0.42f;  // in cells of the font; share of ink
constexpr size_t kLongestText = 120;

// The font's grid, one byte per cell, `width` cells per row and kFontRows rows: 1 for ink.
std::vector<unsigned char> Ink(std::string text, int width) {
  struct Corner {
    float x, y, z;
    unsigned char colour[4];
  };
  constexpr int kCornersPerCharacter = 100;  // the font recommends 270 bytes per character
  std::vector<Corner> corners(kCornersPerCharacter * (text.size() + 1));
  const int boxes = stb_easy_font_print(0, 0, text.data(), nullptr, corners.data(),
                                        static_cast<int>(corners.size() * sizeof(Corner)));
  std::vector<unsigned char> ink(width * kFontRows, 0);
  for (int i = 0; i < boxes; ++i) {
    const Corner &low = corners[4 * i], &high = corners[4 * i + 2];
    // The corners are integers.
    const Eigen::Vector2i from(std::max(0.0f, low.x), std::max(0.0f, low.y));
    const Eigen::Vector2i to(std::min<float>(width, high.x), std::min<float>(kFontRows, high.y));
    for (int y = from.y(); y < to.y(); ++y) {
      for (int x = from.x(); x < to.x(); ++x) ink[y * width + x] = 1;
    }
  }
  return ink;
}

}  // namespace

void CheckText(const char* field, const std::string& text) {
  if (text.size() > kLongestText) {
    throw InvalidOptions(field, "longer than " + std::to_string(kLongestText) + " characters");
  }
  if (std::any_of(text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; })) {
    throw InvalidOptions(field, "only printable ASCII characters can be drawn");
  }
}

Colour TextColour() {
  static const Colour colour = FromHex(0x404448);
  return colour;
}

int TextWidth(std::string text) { return kTextScale * stb_easy_font_width(text.data()); }

void Fill(RgbImage* image, int x0, int y0, int x1, int y1, const Colour& colour) {
  for (int y = std::max(0, y0); y < std::min(image->height, y1); ++y) {
    for (int x = std::max(0, x0); x < std::min(image->width, x1); ++x) {
      for (int k = 0; k < 3; ++k) {
        image->pixels[3 * (static_cast<size_t>(y) * image->width + x) + k] = ToByte(colour[k]);
      }
    }
  }
}

// The font's boxes, blurred and thresholded at half: that rounds corners and joins diagonals.
void DrawText(RgbImage* image, int left, int top, const std::string& text) {
  const int width = TextWidth(text) / kTextScale;
  const std::vector<unsigned char> ink = Ink(text, width);
  const auto blurred = [&](float x, float y) {
    float sum = 0, total = 0;
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    for (int j = row - 2; j <= row + 2; ++j) {
      for (int i = column - 2; i <= column + 2; ++i) {
        const float dx = i + 0.5f - x, dy = j + 0.5f - y;
        const float weight = std::exp(-(dx * dx + dy * dy) / (2 * kBlur * kBlur));
        total += weight;
        if (i >= 0 && j >= 0 && i < width && j < kFontRows) sum += weight * ink[j * width + i];
      }
    }
    return sum / total;
  };
  const Colour colour = TextColour();
  for (int y = 0; y < kFontRows * kTextScale; ++y) {
    for (int x = 0; x < width * kTextScale; ++x) {
      int inside = 0;
      for (int s = 0; s < kTextSamples * kTextSamples; ++s) {
        const int column = s % kTextSamples, row = s / kTextSamples;
        inside += blurred((x + (column + 0.5f) / kTextSamples) / kTextScale,
                          (y + (row + 0.5f) / kTextSamples) / kTextScale) > kCut;
      }
      const float share = static_cast<float>(inside) / (kTextSamples * kTextSamples);
      if (share > 0) {
        Fill(image, left + x, top + y, left + x + 1, top + y + 1,
             share * colour + (1 - share) * Background());
      }
    }
  }
}

}  // namespace shapespace::internal
