#include <shapespace/base/internal/ranges.h>

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace shapespace::internal {
namespace {

using Ranges = std::vector<std::pair<int, int>>;

Ranges RangesOf(int count, int per_task) {
  Ranges ranges;
  std::mutex mutex;
  ForRanges(
      count,
      [&](int begin, int end) {
        const std::lock_guard<std::mutex> lock(mutex);
        ranges.emplace_back(begin, end);
      },
      per_task);
  std::sort(ranges.begin(), ranges.end());
  return ranges;
}

TEST(ForRangesTest, CoverAllIndicesOnce) {
  EXPECT_EQ(RangesOf(0, 4), Ranges());
  EXPECT_EQ(RangesOf(1, 4), (Ranges{{0, 1}}));
  EXPECT_EQ(RangesOf(4, 4), (Ranges{{0, 4}}));
  EXPECT_EQ(RangesOf(5, 4), (Ranges{{0, 4}, {4, 5}}));
  EXPECT_EQ(RangesOf(12, 4), (Ranges{{0, 4}, {4, 8}, {8, 12}}));
  EXPECT_EQ(RangesOf(15, 4), (Ranges{{0, 4}, {4, 8}, {8, 12}, {12, 15}}));
  EXPECT_EQ(RangesOf(3, 1), (Ranges{{0, 1}, {1, 2}, {2, 3}}));
}

TEST(ForIndicesTest, CallTheBodyOnceForEveryIndex) {
  for (const int count : {0, 1, 511, 512, 513, 1500}) {
    std::vector<int> calls(count, 0), once(count, 1);
    ForIndices(count, [&](int i) { ++calls[i]; });
    EXPECT_EQ(calls, once) << count;
  }
}

}  // namespace
}  // namespace shapespace::internal
