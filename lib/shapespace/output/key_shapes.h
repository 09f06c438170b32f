#ifndef SHAPESPACE_OUTPUT_KEY_SHAPES_H_
#define SHAPESPACE_OUTPUT_KEY_SHAPES_H_

#include <vector>

namespace shapespace::internal {

/// Indices of at most `most` (2 or more) of `count` shapes, rising, as evenly spread as the ends
/// and `poses` allow, which are kept; of too many poses as many as fit, evenly, with the ends.
std::vector<int> KeyShapes(int count, const std::vector<int>& poses, int most);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_KEY_SHAPES_H_
