#ifndef SHAPESPACE_OUTPUT_DETAIL_RULER_H_
#define SHAPESPACE_OUTPUT_DETAIL_RULER_H_

#include <string>

#include <shapespace/output/picture.h>

namespace shapespace::internal {

/// The ground of a strip seen from the side: a line with ticks at round places of the world. All
/// cells show the same part of the world, so that ticks have the same columns in each.
struct Ruler {
  double height = 0;      ///< of the ground, in the shapes' unit
  double step = 1;        ///< between ticks, in the shapes' unit: 1, 2 or 5 times a power of ten
  double pixels = 1;      ///< between ticks
  double first_tick = 0;  ///< a tick's column in a cell
  int row = 0;            ///< of the line's upper edge in a cell
  int cell_width = 0;     ///< in pixels
};

/// The step of a ruler of which `length`, in the shapes' unit, is seen.
double RulerStep(double length);

/// Pixels below `Ruler::row` that line and ticks take, with text of this size.
int RulerDepth(int text_size);

/// Draws the line, its ticks, and a pale line from each tick to the top of the cell, into the cell
/// whose upper left pixel is (left, top).
void DrawRuler(const Ruler& ruler, int text_size, int left, int top, RgbImage* image);

/// What the ruler shows: the height of the line and the step.
std::string DescribeRuler(const Ruler& ruler);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_RULER_H_
