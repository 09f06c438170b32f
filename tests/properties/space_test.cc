#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include <shapespace/exploration/explore.h>

#include "properties/compare.h"
#include "properties/methods.h"
#include "properties/random_body.h"

namespace shapespace {
namespace {

using testing::AreCongruent;
using testing::RandomBody;

ExploreOptions Accurate(const RandomBody& body) {
  ExploreOptions options;
  options.geodesic = testing::AccurateGeodesic(body, 3);
  options.depth = 1;
  return options;
}

// The greatest difference of two matrices of distances, as a share of the greatest distance.
double Off(const Eigen::MatrixXd& distances, const Eigen::MatrixXd& expected) {
  return (distances - expected).cwiseAbs().maxCoeff() / expected.maxCoeff();
}

template <class Test>
void ForAllSpaces(const Test& test) {
  testing::ForAllKinds({1}, 4, [&](const RandomBody& body) {
    test(body, Explore(body.connectivity, body.poses, {}, Accurate(body)).space);
  });
}

TEST(RandomSpace, DistancesAreThoseOfAMetricSpace) {
  ForAllSpaces([](const RandomBody&, const PoseSpace& space) {
    const Eigen::MatrixXd& d = space.distances;
    EXPECT_EQ(d, d.transpose());
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        EXPECT_EQ(d(i, j) > 0, i != j);
        // With four segments a length is short by up to a share of a constant over 4^2.
        for (int k = 0; k < 4; ++k) EXPECT_LE(d(i, j), (1 + 4e-3) * (d(i, k) + d(k, j)));
      }
    }
  });
}

TEST(RandomSpace, NodesAreThePosesWhereTheyAreOnThePlane) {
  ForAllSpaces([](const RandomBody& body, const PoseSpace& space) {
    for (int i = 0; i < 4; ++i) {
      EXPECT_TRUE(AreCongruent(body, {space.At(space.points.col(i))}, {body.poses[i]}, 1e-8));
    }
  });
}

TEST(RandomSpace, DistancesDoNotDependOnUnitPlaceOrNumbers) {
  ForAllSpaces([](const RandomBody& body, const PoseSpace& space) {
    testing::Random random(7);
    const RandomBody moved = testing::Moved(body, 1000, random.Rotation(), {10, -20, 5});
    const testing::Renumbered other = testing::Renumber(body, 8);
    for (const RandomBody& same : {moved, other.body}) {
      const Eigen::MatrixXd d = DistanceMatrix(same.connectivity, same.poses, Accurate(same));
      EXPECT_LT(Off(d, space.distances), 1e-6);
    }
    const std::vector<Shape> reversed = testing::Reversed(body.poses);
    const Eigen::MatrixXd d = DistanceMatrix(body.connectivity, reversed, Accurate(body));
    EXPECT_LT(Off(d, space.distances.reverse()), 1e-6);
  });
}

}  // namespace
}  // namespace shapespace
