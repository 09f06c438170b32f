#include <shapespace/mesh/internal/box_tree.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <random>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace shapespace::internal {
namespace {

struct Boxes {
  Eigen::Matrix3Xd low, high;
};

// Boxes of all sizes about random points of a cube, some of them points, some of them repeated.
Boxes RandomBoxes(int count, double scale, double offset) {
  std::mt19937_64 random(count);
  std::uniform_real_distribution<double> unit(0, 1);
  Boxes boxes{Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count)};
  for (int i = 0; i < count; ++i) {
    const double size = i % 5 == 0 ? 0 : 0.3 * unit(random) * unit(random);
    for (int axis = 0; axis < 3; ++axis) {
      const double at = unit(random);
      boxes.low(axis, i) = scale * at + offset;
      boxes.high(axis, i) = scale * (at + size) + offset;
    }
    if (i % 7 == 6) {
      boxes.low.col(i) = boxes.low.col(i - 1);
      boxes.high.col(i) = boxes.high.col(i - 1);
    }
  }
  return boxes;
}

double Distance(const Boxes& boxes, int i, const Eigen::Vector3d& point) {
  return (boxes.low.col(i) - point).cwiseMax(point - boxes.high.col(i)).cwiseMax(0).norm();
}

class BoxTrees : public ::testing::TestWithParam<std::pair<double, double>> {
 protected:
  Boxes MakeBoxes(int count) const {
    return RandomBoxes(count, GetParam().first, GetParam().second);
  }
};

TEST_P(BoxTrees, AllBoxesWithinADistanceAreVisited) {
  for (const int count : {2, 3, 17, 200}) {
    const Boxes boxes = MakeBoxes(count);
    const BoxTree tree(boxes.low, boxes.high);
    for (const double share : {0.0, 0.05, 0.4, std::numeric_limits<double>::infinity()}) {
      const Eigen::Vector3d point = boxes.high.col(count / 2);
      const double within = share == 0 ? 0 : share * GetParam().first;
      std::set<int> visited;
      tree.VisitNear(point, within, [&](int i) {
        visited.insert(i);
        return within;
      });
      for (int i = 0; i < count; ++i) {
        EXPECT_TRUE(Distance(boxes, i, point) > within || visited.count(i) == 1)
            << i << " of " << count;
      }
    }
  }
}

TEST_P(BoxTrees, OfEquallyNearBoxesNoneIsLeftOutWhenTheDistanceBecomesLess) {
  const int count = 300;
  const Boxes boxes = MakeBoxes(count);
  const BoxTree tree(boxes.low, boxes.high);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> beyond(-1, 2);
  int visits = 0;
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::Vector3d point;
    for (double& x : point) x = GetParam().first * beyond(random) + GetParam().second;
    double nearest = std::numeric_limits<double>::infinity();
    std::set<int> visited;
    tree.VisitNear(point, nearest, [&](int i) {
      visited.insert(i);
      return nearest = std::min(nearest, Distance(boxes, i, point));
    });
    visits += static_cast<int>(visited.size());
    double expected = std::numeric_limits<double>::infinity();
    for (int i = 0; i < count; ++i) expected = std::min(expected, Distance(boxes, i, point));
    EXPECT_EQ(nearest, expected);
    for (int i = 0; i < count; ++i) {
      EXPECT_TRUE(Distance(boxes, i, point) > expected || visited.count(i) == 1);
    }
  }
  EXPECT_LT(visits, 50 * count / 3);  // it is a search, and no list of all
}

TEST_P(BoxTrees, AllPairsThatIntersectAreVisitedInOrder) {
  const int count = 200;
  const Boxes boxes = MakeBoxes(count);
  const BoxTree tree(boxes.low, boxes.high);
  std::mutex mutex;
  std::set<std::pair<int, int>> visited;
  tree.VisitPairs([&](int first, int second) {
    const std::lock_guard<std::mutex> lock(mutex);
    visited.emplace(first, second);
  });
  for (const auto& [first, second] : visited) EXPECT_LT(first, second);
  EXPECT_LT(visited.size(), count * count / 4u);
  for (int j = 1; j < count; ++j) {
    for (int i = 0; i < j; ++i) {
      const bool apart = (boxes.low.col(i).array() > boxes.high.col(j).array()).any() ||
                         (boxes.low.col(j).array() > boxes.high.col(i).array()).any();
      EXPECT_TRUE(apart || visited.count({i, j}) == 1) << i << " and " << j;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ScalesAndPlaces, BoxTrees,
                         ::testing::Values(std::pair(1.0, 0.0), std::pair(1e-3, 1.0),
                                           std::pair(1000.0, -1e9)));

}  // namespace
}  // namespace shapespace::internal
