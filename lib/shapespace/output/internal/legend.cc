#include <shapespace/output/internal/legend.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <shapespace/output/internal/colour.h>
#include <shapespace/output/internal/frame.h>
#include <shapespace/output/internal/text.h>

namespace shapespace::internal {
namespace {

constexpr int kBarWidth = 240, kBarHeight = 14, kGap = 16;
constexpr int kMargin = 12;
constexpr int kNumbersTop = kMargin + kBarHeight + 6;
constexpr int kSwatchWidth = 34, kMaxSwatches = 24;

// Relative values below this are rounding errors, and are shown as 0.
constexpr double kNoise = 1e-12;

std::string PerCent(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g%%", 100 * value);
  return text;
}

RgbImage BlankLegend(int width) {
  RgbImage image;
  image.width = width;
  image.height = 2 * kMargin + kBarHeight + kTextHeight;
  image.pixels.resize(3 * static_cast<size_t>(image.width) * image.height);
  Fill(&image, 0, 0, image.width, image.height, Background());
  return image;
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

RgbImage DrawLegend(double end_of_scale, double largest, const std::string& title) {
  std::string text = title;
  if (largest > end_of_scale) text += (text.empty() ? "" : ", ") + ("up to " + PerCent(largest));
  const std::string first = "0", middle = PerCent(end_of_scale / 2), last = PerCent(end_of_scale);
  const int bar_left = kMargin + TextWidth(first) / 2;
  const int after_bar = bar_left + kBarWidth + TextWidth(last) / 2;

  RgbImage image = BlankLegend(after_bar + kGap + TextWidth(text) + kMargin);
  for (int x = 0; x < kBarWidth; ++x) {
    Fill(&image, bar_left + x, kMargin, bar_left + x + 1, kMargin + kBarHeight,
         ValueColour((x + 0.5f) / kBarWidth));
  }
  const auto number = [&](int x, const std::string& n) {
    Fill(&image, x - 1, kMargin + kBarHeight, x + 1, kMargin + kBarHeight + 4, TextColour());
    DrawText(&image, x - TextWidth(n) / 2, kNumbersTop, n);
  };
  number(bar_left + 1, first);
  number(bar_left + kBarWidth / 2, middle);
  number(bar_left + kBarWidth - 1, last);
  DrawText(&image, after_bar + kGap, kMargin, text);
  return image;
}

RgbImage DrawGroupLegend(int groups, const std::string& title) {
  const int swatches = std::min(groups, kMaxSwatches);
  const int after_swatches = kMargin + swatches * kSwatchWidth;
  RgbImage image = BlankLegend(after_swatches + kGap + TextWidth(title) + kMargin);
  for (int group = 0; group < swatches; ++group) {
    const int left = kMargin + group * kSwatchWidth;
    Fill(&image, left, kMargin, left + kSwatchWidth - 4, kMargin + kBarHeight, GroupColour(group));
    const std::string number = std::to_string(group + 1);
    DrawText(&image, left + (kSwatchWidth - 4 - TextWidth(number)) / 2, kNumbersTop, number);
  }
  DrawText(&image, after_swatches + kGap, kMargin, title);
  return image;
}

}  // namespace shapespace::internal
