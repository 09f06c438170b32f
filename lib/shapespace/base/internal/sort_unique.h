#ifndef SHAPESPACE_BASE_INTERNAL_SORT_UNIQUE_H_
#define SHAPESPACE_BASE_INTERNAL_SORT_UNIQUE_H_

#include <algorithm>
#include <vector>

namespace shapespace::internal {

/// Puts the items in ascending order and leaves one of each.
template <typename T>
void SortUnique(std::vector<T>* items) {
  std::sort(items->begin(), items->end());
  items->erase(std::unique(items->begin(), items->end()), items->end());
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_SORT_UNIQUE_H_
