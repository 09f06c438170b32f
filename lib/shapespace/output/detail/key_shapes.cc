#include <shapespace/output/detail/key_shapes.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <shapespace/base/internal/sort_unique.h>

namespace shapespace::internal {
namespace {

// Appends `parts` + 1 evenly spaced integers from `first` to `last`, without the last one.
void AppendParts(int first, int last, int parts, std::vector<int>* numbers) {
  for (int j = 0; j < parts; ++j) {
    numbers->push_back(first + static_cast<int>(std::lround(double(j) * (last - first) / parts)));
  }
}

}  // namespace

std::vector<int> KeyShapes(int count, const std::vector<int>& poses, int most) {
  std::vector<int> kept = poses;
  kept.insert(kept.end(), {0, count - 1});
  SortUnique(&kept);
  std::vector<int> keys;
  if (static_cast<int>(kept.size()) > most) {
    AppendParts(0, static_cast<int>(kept.size()) - 1, most - 1, &keys);
    for (int& key : keys) key = kept[key];
    keys.push_back(count - 1);
    return keys;
  }

  // Each additional key goes to the widest gap.
  std::vector<int> parts(kept.size() - 1, 1);
  const auto gap = [&](size_t i) { return double(kept[i + 1] - kept[i]) / parts[i]; };
  for (int used = static_cast<int>(kept.size()); used < std::min(count, most); ++used) {
    size_t widest = 0;
    for (size_t i = 1; i < parts.size(); ++i) {
      if (gap(i) > gap(widest)) widest = i;
    }
    ++parts[widest];
  }
  for (size_t i = 0; i < parts.size(); ++i) AppendParts(kept[i], kept[i + 1], parts[i], &keys);
  keys.push_back(count - 1);
  return keys;
}

}  // namespace shapespace::internal
