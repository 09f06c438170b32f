#include <shapespace/output/detail/indexed_film.h>

#include <algorithm>
#include <cmath>

namespace shapespace::internal {
namespace {

// Files have a further number for pixels that do not change.
constexpr int kMostColours = 255;

// In hundredths of a second; files have 16 bits for it.
constexpr int kLongestFrame = 60000;

// The part of picture `next` that differs from `before`; of no width if nothing does.
IndexedFilm::Frame Difference(const std::vector<unsigned char>& before,
                              const std::vector<unsigned char>& next, const IndexedFilm& film) {
  int left = film.width, right = 0, top = film.height, bottom = 0;
  for (int y = 0; y < film.height; ++y) {
    for (int x = 0; x < film.width; ++x) {
      const size_t i = static_cast<size_t>(y) * film.width + x;
      if (before[i] == next[i]) continue;
      left = std::min(left, x);
      right = std::max(right, x + 1);
      top = std::min(top, y);
      bottom = y + 1;
    }
  }
  IndexedFilm::Frame frame;
  if (right == 0) return frame;
  frame.left = left;
  frame.top = top;
  frame.width = right - left;
  frame.height = bottom - top;
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const size_t i = static_cast<size_t>(y) * film.width + x;
      frame.pixels.push_back(before[i] == next[i] ? film.Unchanged() : next[i]);
    }
  }
  return frame;
}

}  // namespace

IndexedFilm MakeIndexedFilm(const Film& film) {
  film.Validate();
  const Palette palette = MakePalette(film.pictures, kMostColours);
  IndexedFilm result;
  result.width = film.pictures.front().width;
  result.height = film.pictures.front().height;
  result.colours = palette.colours;
  double time = 0;
  int hundredths = 0;
  for (size_t i = 0; i < film.order.size(); ++i) {
    const std::vector<unsigned char>& next = palette.pixels[film.order[i]];
    IndexedFilm::Frame frame;
    if (i == 0) {
      frame = {0, 0, result.width, result.height, next, 0};
    } else {
      frame = Difference(palette.pixels[film.order[i - 1]], next, result);
    }
    // Sums are rounded, not single times, so that errors do not add up.
    time += film.seconds[i];
    const int until = static_cast<int>(std::lround(100 * time));
    const int shown = until - hundredths;
    if (frame.width == 0 && result.frames.back().hundredths + shown > kLongestFrame) {
      frame = {0, 0, 1, 1, {result.Unchanged()}, 0};
    }
    if (frame.width > 0) result.frames.push_back(std::move(frame));
    result.frames.back().hundredths += shown;
    hundredths = until;
  }
  return result;
}

}  // namespace shapespace::internal
