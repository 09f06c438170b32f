#include <shapespace/output/detail/ruler.h>

#include <cmath>
#include <cstdio>

#include <shapespace/output/internal/colour.h>
#include <shapespace/output/internal/text.h>

namespace shapespace::internal {
namespace {

constexpr double kFewestTicks = 3;  // in a cell
constexpr unsigned kGuideHex = 0xe6e6e4, kGroundHex = 0x70706c;

int Thickness(int text_size) { return text_size / 10; }

}  // namespace

double RulerStep(double length) {
  const double most = length / kFewestTicks;
  if (!(most > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (const double step : {5.0, 2.0}) {
    if (step * power <= most) return step * power;
  }
  return power;
}

int RulerDepth(int text_size) { return Thickness(text_size) + text_size / 3; }

void DrawRuler(const Ruler& ruler, int text_size, int left, int top, RgbImage* image) {
  const Colour guide = FromHex(kGuideHex), ground = FromHex(kGroundHex);
  const int thickness = Thickness(text_size), right = left + ruler.cell_width;
  const double before = std::floor(ruler.first_tick / ruler.pixels);
  for (double x = ruler.first_tick - before * ruler.pixels; x < ruler.cell_width;
       x += ruler.pixels) {
    const int column = left + static_cast<int>(std::lround(x)) - thickness / 2;
    if (column < left || column + thickness > right) continue;
    Fill(image, column, top, column + thickness, top + ruler.row, guide);
    Fill(image, column, top + ruler.row, column + thickness,
         top + ruler.row + RulerDepth(text_size), ground);
  }
  Fill(image, left, top + ruler.row, right, top + ruler.row + thickness, ground);
}

std::string DescribeRuler(const Ruler& ruler) {
  char text[96];
  std::snprintf(text, sizeof(text), "ground at %.6g, ticks %.6g apart", ruler.height, ruler.step);
  return text;
}

}  // namespace shapespace::internal
