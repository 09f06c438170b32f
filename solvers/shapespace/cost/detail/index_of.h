#ifndef SHAPESPACE_COST_DETAIL_INDEX_OF_H_
#define SHAPESPACE_COST_DETAIL_INDEX_OF_H_

#include <algorithm>
#include <vector>

// Numbers parameter blocks in the order of their first use.

namespace shapespace::cost {

/// The index of `value` in `list`; appends it if it is missing.
inline int IndexOf(int value, std::vector<int>* list) {
  const auto found = std::find(list->begin(), list->end(), value);
  const int index = static_cast<int>(found - list->begin());
  if (found == list->end()) list->push_back(value);
  return index;
}

}  // namespace shapespace::cost

#endif  // SHAPESPACE_COST_DETAIL_INDEX_OF_H_
