#ifndef SHAPESPACE_OUTPUT_DETAIL_KEY_SHAPES_H_
#define SHAPESPACE_OUTPUT_DETAIL_KEY_SHAPES_H_

#include <vector>

namespace shapespace::internal {

/// Indices of at most `most` (2 or more) of `count` shapes, ascending. They include the ends and
/// `poses` and are otherwise evenly spaced; if there are too many poses, an evenly spaced selection
/// of them and the ends.
std::vector<int> KeyShapes(int count, const std::vector<int>& poses, int most);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_KEY_SHAPES_H_
