#ifndef SHAPESPACE_STATISTICS_DETAIL_PERMUTATIONS_H_
#define SHAPESPACE_STATISTICS_DETAIL_PERMUTATIONS_H_

#include <cstdint>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace shapespace::internal {

/// Random orders of the numbers from 0 to count - 1: the same ones for a seed on any machine, as
/// those of std::shuffle are not.
class Permutations {
 public:
  Permutations(int count, unsigned seed) : order_(count), random_(seed) {
    std::iota(order_.begin(), order_.end(), 0);
  }

  const std::vector<int>& Next() {
    for (size_t i = order_.size(); i > 1; --i) std::swap(order_[i - 1], order_[Below(i)]);
    return order_;
  }

 private:
  // Numbers of the last, incomplete stretch of `count` are drawn again: all are equally likely.
  size_t Below(std::uint64_t count) {
    const std::uint64_t end = UINT64_MAX - UINT64_MAX % count;
    std::uint64_t number;
    do number = random_();
    while (number >= end);
    return number % count;
  }

  std::vector<int> order_;
  std::mt19937_64 random_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_STATISTICS_DETAIL_PERMUTATIONS_H_
