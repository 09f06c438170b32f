#include <shapespace/output/legend.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include <stb_easy_font.h>

#include <shapespace/output/colour.h>
#include <shapespace/output/frame.h>

namespace shapespace {
namespace {

constexpr int kTextScale = 2;
constexpr int kFontRows = 12;  // with descenders
constexpr int kTextSamples = 4;
constexpr float kBlur = 0.5f, kCut = 0.42f;  // in cells of the font; share of ink
constexpr int kLineHeight = 10 * kTextScale;
constexpr int kBarWidth = 240, kBarHeight = 14, kGap = 16;
constexpr int kMargin = 12;
constexpr unsigned kTextHex = 0x404448;

// Relative values below this are rounding errors, and shown as 0.
constexpr double kNoise = 1e-12;

int TextWidth(std::string text) { return kTextScale * stb_easy_font_width(text.data()); }

void Fill(Image* image, int x0, int y0, int x1, int y1, const Colour& colour) {
  for (int y = std::max(0, y0); y < std::min(image->height, y1); ++y) {
    for (int x = std::max(0, x0); x < std::min(image->width, x1); ++x) {
      for (int k = 0; k < 3; ++k) {
        image->pixels[3 * (static_cast<size_t>(y) * image->width + x) + k] = ToByte(colour[k]);
      }
    }
  }
}

// One byte a cell of the font's grid, `width` cells a row and kFontRows rows: 1 where there is ink.
std::vector<unsigned char> Ink(std::string text, int width) {
  struct Corner {
    float x, y, z;
    unsigned char colour[4];
  };
  constexpr int kCornersPerCharacter = 100;  // the font's own advice is 270 bytes a character
  std::vector<Corner> corners(kCornersPerCharacter * (text.size() + 1));
  const int boxes = stb_easy_font_print(0, 0, text.data(), nullptr, corners.data(),
                                        static_cast<int>(corners.size() * sizeof(Corner)));
  std::vector<unsigned char> ink(width * kFontRows, 0);
  for (int i = 0; i < boxes; ++i) {
    const Corner &low = corners[4 * i], &high = corners[4 * i + 2];
    // The corners are whole numbers.
    const Eigen::Vector2i from(std::max(0.0f, low.x), std::max(0.0f, low.y));
    const Eigen::Vector2i to(std::min<float>(width, high.x), std::min<float>(kFontRows, high.y));
    for (int y = from.y(); y < to.y(); ++y) {
      for (int x = from.x(); x < to.x(); ++x) ink[y * width + x] = 1;
    }
  }
  return ink;
}

// The font's boxes, blurred and cut off again where the blur is half: that rounds its corners and
// joins its diagonals.
void DrawText(Image* image, int left, int top, const std::string& text) {
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
  const Colour colour = FromHex(kTextHex);
  for (int y = 0; y < kFontRows * kTextScale; ++y) {
    for (int x = 0; x < width * kTextScale; ++x) {
      int inside = 0;
      for (int s = 0; s < kTextSamples * kTextSamples; ++s) {
        inside += blurred((x + (s % kTextSamples + 0.5f) / kTextSamples) / kTextScale,
                          (y + (s / kTextSamples + 0.5f) / kTextSamples) / kTextScale) > kCut;
      }
      const float share = static_cast<float>(inside) / (kTextSamples * kTextSamples);
      if (share > 0) {
        Fill(image, left + x, top + y, left + x + 1, top + y + 1,
             share * colour + (1 - share) * Background());
      }
    }
  }
}

std::string PerCent(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g%%", 100 * value);
  return text;
}

double RoundUp(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    // The percentile itself may be such a number, up to rounding.
    if (value <= step * power * (1 + 1e-9)) return step * power;
  }
  return 10 * power;
}

}  // namespace

double EndOfScale(const std::vector<Eigen::VectorXd>& values) {
  std::vector<double> all;
  for (const Eigen::VectorXd& one : values) all.insert(all.end(), one.begin(), one.end());
  const auto high = all.begin() + static_cast<std::ptrdiff_t>(0.99 * (all.size() - 1));
  std::nth_element(all.begin(), high, all.end());
  double end = *high;
  if (end < kNoise) end = *std::max_element(high, all.end());
  return end < kNoise ? 0.01 : RoundUp(end);
}

Image DrawLegend(double end_of_scale, double largest, const std::string& title) {
  std::string text = title;
  if (largest > end_of_scale) text += (text.empty() ? "" : ", ") + ("up to " + PerCent(largest));
  const std::string first = "0", middle = PerCent(end_of_scale / 2), last = PerCent(end_of_scale);
  const int bar_left = kMargin + TextWidth(first) / 2;
  const int after_bar = bar_left + kBarWidth + TextWidth(last) / 2;

  Image image;
  image.width = after_bar + kGap + TextWidth(text) + kMargin;
  image.height = 2 * kMargin + kBarHeight + kLineHeight;
  image.pixels.resize(3 * static_cast<size_t>(image.width) * image.height);
  Fill(&image, 0, 0, image.width, image.height, Background());
  for (int x = 0; x < kBarWidth; ++x) {
    Fill(&image, bar_left + x, kMargin, bar_left + x + 1, kMargin + kBarHeight,
         ValueColour((x + 0.5f) / kBarWidth));
  }
  const int numbers_top = kMargin + kBarHeight + 6;
  const auto number = [&](int x, const std::string& n) {
    Fill(&image, x - 1, kMargin + kBarHeight, x + 1, kMargin + kBarHeight + 4, FromHex(kTextHex));
    DrawText(&image, x - TextWidth(n) / 2, numbers_top, n);
  };
  number(bar_left + 1, first);
  number(bar_left + kBarWidth / 2, middle);
  number(bar_left + kBarWidth - 1, last);
  DrawText(&image, after_bar + kGap, kMargin, text);
  return image;
}

}  // namespace shapespace
