#include <shapespace/output/detail/legend.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <shapespace/output/detail/frame.h>
#include <shapespace/output/internal/colour.h>
#include <shapespace/output/internal/text.h>

namespace shapespace::internal {
namespace {

constexpr int kMaxSwatches = 24;

// Lengths in pixels, in proportion to the text.
struct Lengths {
  explicit Lengths(int size)
      : text(size),
        bar_width(12 * size),
        bar_height(7 * size / 10),
        gap(4 * size / 5),
        margin(3 * size / 5),
        tick(size / 5),
        swatch(17 * size / 10),
        numbers_top(margin + bar_height + tick) {}

  int text, bar_width, bar_height, gap, margin, tick, swatch, numbers_top;
};

// Relative values below this are rounding errors, and are shown as 0.
constexpr double kNoise = 1e-12;

std::string PerCent(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g%%", 100 * value);
  return text;
}

RgbImage BlankLegend(int width, const Lengths& lengths) {
  RgbImage image;
  image.width = width;
  image.height = lengths.numbers_top + LineHeight(lengths.text) + lengths.margin / 2;
  image.pixels.resize(3 * static_cast<size_t>(image.width) * image.height);
  Fill(&image, 0, 0, image.width, image.height, Background());
  return image;
}

// Height at which a text stands beside a bar.
int TextTop(const Lengths& lengths) {
  return lengths.margin + (lengths.bar_height - LineHeight(lengths.text)) / 2;
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

RgbImage DrawLegend(double end_of_scale, double largest, const std::string& title, int size) {
  const Lengths lengths(size);
  std::string text = title;
  if (largest > end_of_scale) text += (text.empty() ? "" : ", ") + ("up to " + PerCent(largest));
  const std::string first = "0", middle = PerCent(end_of_scale / 2), last = PerCent(end_of_scale);
  const int bar_left = lengths.margin + TextWidth(first, size) / 2;
  const int after_bar = bar_left + lengths.bar_width + TextWidth(last, size) / 2;

  RgbImage image =
      BlankLegend(after_bar + lengths.gap + TextWidth(text, size) + lengths.margin, lengths);
  const int bar_bottom = lengths.margin + lengths.bar_height;
  for (int x = 0; x < lengths.bar_width; ++x) {
    Fill(&image, bar_left + x, lengths.margin, bar_left + x + 1, bar_bottom,
         ValueColour((x + 0.5f) / static_cast<float>(lengths.bar_width)));
  }
  const auto number = [&](int x, const std::string& n) {
    Fill(&image, x - 1, bar_bottom, x + 1, bar_bottom + lengths.tick, TextColour());
    DrawText(&image, x - TextWidth(n, size) / 2, lengths.numbers_top, n, size);
  };
  number(bar_left + 1, first);
  number(bar_left + lengths.bar_width / 2, middle);
  number(bar_left + lengths.bar_width - 1, last);
  DrawText(&image, after_bar + lengths.gap, TextTop(lengths), text, size);
  return image;
}

RgbImage DrawGroupLegend(int groups, const std::string& title, int size) {
  const Lengths lengths(size);
  const int swatches = std::min(groups, kMaxSwatches);
  const int after_swatches = lengths.margin + swatches * lengths.swatch;
  RgbImage image =
      BlankLegend(after_swatches + lengths.gap + TextWidth(title, size) + lengths.margin, lengths);
  const int shown = lengths.swatch - lengths.tick;
  for (int group = 0; group < swatches; ++group) {
    const int left = lengths.margin + group * lengths.swatch;
    Fill(&image, left, lengths.margin, left + shown, lengths.margin + lengths.bar_height,
         GroupColour(group));
    const std::string number = std::to_string(group + 1);
    DrawText(&image, left + (shown - TextWidth(number, size)) / 2, lengths.numbers_top, number,
             size);
  }
  DrawText(&image, after_swatches + lengths.gap, TextTop(lengths), title, size);
  return image;
}

}  // namespace shapespace::internal
