#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/analysis/distance.h>

namespace shapespace {
namespace {

constexpr PairKind kKinds[] = {PairKind::kVertexTriangle, PairKind::kEdgeEdge};

FourPoints Points(const std::array<Eigen::Vector3d, 4>& points) {
  FourPoints result;
  for (int k = 0; k < 4; ++k) result.col(k) = points[k];
  return result;
}

FourPoints RandomPoints(std::mt19937* random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  FourPoints points;
  for (double& x : points.reshaped()) x = uniform(*random);
  return points;
}

double Distance(PairKind kind, const FourPoints& points) {
  return NearestPoints(kind, points).Distance();
}

// The least distance between points of the two elements at equidistant barycentric coordinates.
double SampledDistance(PairKind kind, const FourPoints& points, int samples) {
  double least = 1e300;
  for (int i = 0; i <= samples; ++i) {
    const double s = static_cast<double>(i) / samples;
    for (int j = 0; j <= (kind == PairKind::kVertexTriangle ? samples - i : samples); ++j) {
      const double t = static_cast<double>(j) / samples;
      Eigen::Vector4d coefficients(1, -s, -t, s + t - 1);
      if (kind == PairKind::kEdgeEdge) coefficients << 1 - s, s, t - 1, -t;
      least = std::min(least, (points * coefficients).norm());
    }
  }
  return least;
}

TEST(NearestPointsTest, AVertexIsNearestToTheInsideASideOrACornerOfATriangle) {
  const auto distance = [](double x, double y, double z) {
    return Distance(PairKind::kVertexTriangle,
                    Points({Eigen::Vector3d(x, y, z), {0, 0, 0}, {3, 0, 0}, {0, 3, 0}}));
  };
  EXPECT_DOUBLE_EQ(distance(1, 1, 2), 2);                    // above the inside
  EXPECT_DOUBLE_EQ(distance(1, -3, 4), 5);                   // beside a side
  EXPECT_DOUBLE_EQ(distance(-2, -3, 6), 7);                  // at a corner
  EXPECT_DOUBLE_EQ(distance(3, 3, 0), 1.5 * std::sqrt(2.));  // beside the longest side
  EXPECT_DOUBLE_EQ(distance(7, -3, 0), 5);                   // at another corner
  EXPECT_DOUBLE_EQ(distance(1, 1, 0), 0);
}

TEST(NearestPointsTest, EdgesAreNearestInsideAtEndsOrAlongAWholePart) {
  const auto distance = [](const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
    return Distance(PairKind::kEdgeEdge, Points({Eigen::Vector3d(0, 0, 0), {4, 0, 0}, c, d}));
  };
  EXPECT_DOUBLE_EQ(distance({2, -1, 3}, {2, 1, 3}), 3);  // crossing, seen from above
  EXPECT_DOUBLE_EQ(distance({1, 2, 0}, {3, 2, 0}), 2);   // parallel, beside each other
  EXPECT_DOUBLE_EQ(distance({7, 4, 0}, {9, 4, 0}), 5);   // parallel, one behind the other
  EXPECT_DOUBLE_EQ(distance({7, 4, 0}, {7, 9, 0}), 5);   // end to end
  EXPECT_DOUBLE_EQ(distance({2, 1, 0}, {2, 5, 0}), 1);   // an end to the inside
  EXPECT_DOUBLE_EQ(distance({2, 1, 0}, {2, 1, 0}), 1);   // an edge without length
  EXPECT_DOUBLE_EQ(distance({-3, 4, 0}, {-3, 4, 0}), 5);
}

TEST(NearestPointsTest, NoSampledPointsOfTheElementsAreNearer) {
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    for (const PairKind kind : kKinds) {
      FourPoints points = RandomPoints(&random, 1);
      if (i % 5 == 0) points.col(3) = points.col(2);                                  // degenerate
      if (i % 5 == 1) points.col(3) = points.col(2) + points.col(1) - points.col(0);  // parallel
      const double distance = Distance(kind, points);
      constexpr int kSamples = 60;
      const double sampled = SampledDistance(kind, points, kSamples);
      EXPECT_LE(distance, sampled + 1e-12);
      EXPECT_GE(distance, sampled - 4. / kSamples);
    }
  }
}

TEST(NearestPointsTest, CoefficientsAreDerivativesOfTheDistance) {
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    for (const PairKind kind : kKinds) {
      const FourPoints points = RandomPoints(&random, 1);
      const Separation separation = NearestPoints(kind, points);
      EXPECT_NEAR(separation.coefficients.sum(), 0, 1e-14);
      const FourPoints direction = RandomPoints(&random, 1);
      constexpr double kStep = 1e-6;
      const double differences = (Distance(kind, points + kStep * direction) -
                                  Distance(kind, points - kStep * direction)) /
                                 (2 * kStep);
      const double exact =
          separation.difference.dot(direction * separation.coefficients) / separation.Distance();
      EXPECT_NEAR(differences, exact, 1e-6);
    }
  }
}

TEST(SafeStepTest, AFallingVertexStopsAtThePartOfTheHeightThatIsKept) {
  const FourPoints points = Points({Eigen::Vector3d(1, 1, 2), {0, 0, 0}, {3, 0, 0}, {0, 3, 0}});
  FourPoints velocities = FourPoints::Zero();
  velocities(2, 0) = -8;
  EXPECT_DOUBLE_EQ(SafeStep(PairKind::kVertexTriangle, points, velocities, 0.25), 1.5 / 8);
  // Both moving at half the speed is the same, and a common velocity changes nothing.
  velocities(2, 0) = -4;
  velocities.row(2).tail(3).setConstant(4);
  velocities.colwise() += Eigen::Vector3d(100, 200, 300);
  EXPECT_NEAR(SafeStep(PairKind::kVertexTriangle, points, velocities, 0.25), 1.5 / 8, 1e-14);
  // It does not come so far.
  EXPECT_EQ(SafeStep(PairKind::kVertexTriangle, points, velocities / 6, 0.25), 1);
  // Away, or nowhere.
  EXPECT_EQ(SafeStep(PairKind::kVertexTriangle, points, -velocities, 0.25), 1);
  EXPECT_EQ(SafeStep(PairKind::kVertexTriangle, points, FourPoints::Zero(), 0.25), 1);
}

TEST(SafeStepTest, ElementsThatTouchDoNotMove) {
  const FourPoints points = Points({Eigen::Vector3d(1, 1, 0), {0, 0, 0}, {3, 0, 0}, {0, 3, 0}});
  FourPoints velocities = FourPoints::Zero();
  velocities(2, 0) = 1;
  EXPECT_EQ(SafeStep(PairKind::kVertexTriangle, points, velocities, 0.25), 0);
}

TEST(SafeStepTest, ElementsThatSlideAlongEachOtherByRoundingEndToo) {
  for (const double height : {1e-3, 1e-9, 1e-17}) {
    const FourPoints points =
        Points({Eigen::Vector3d(1, 1, height), {0, 0, 0}, {3, 0, 0}, {0, 3, 0}});
    FourPoints velocities = FourPoints::Zero();
    velocities.col(0) << 0.3, -0.7, 0.1 * height;
    const double step = SafeStep(PairKind::kVertexTriangle, points, velocities, 0.05);
    EXPECT_GT(step, 0);
    EXPECT_GE(Distance(PairKind::kVertexTriangle, points + step * velocities), 0.05 * height);
  }
}

// Of a sliver of length 1, to its full width, and of one without any.
TEST(SafeStepTest, NoVertexFallsThroughASliver) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  for (const double height : {1e-3, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 0.}) {
    for (int i = 0; i < 2000; ++i) {
      const double tip = uniform(random), x = 0.1 + 0.8 * uniform(random);
      const double width = height * std::min(x / tip, (1 - x) / (1 - tip));
      const double above = 0.01 + 0.3 * uniform(random);
      FourPoints points = Points({Eigen::Vector3d(x, width * uniform(random), above),
                                  {0, 0, 0},
                                  {1, 0, 0},
                                  {tip, height, 0}});
      FourPoints velocities = FourPoints::Zero();
      velocities(2, 0) = -2 * above;
      const double a = normal(random), b = normal(random), c = normal(random);
      const Eigen::Matrix3d turn =
          Eigen::Quaterniond(a, b, c, normal(random)).normalized().toRotationMatrix();
      points = (turn * points).colwise() + Eigen::Vector3d(a, b, c);
      velocities = turn * velocities;
      EXPECT_NEAR(Distance(PairKind::kVertexTriangle, points), above, 1e-14);
      const double step = SafeStep(PairKind::kVertexTriangle, points, velocities, 0.2);
      EXPECT_LT(step, 0.5) << height;
      EXPECT_GT(step, 0.38);
    }
  }
}

TEST(SafeStepTest, TheDistanceStaysAboveItsPartAndIsNearItAtTheEnd) {
  std::mt19937 random(3);
  int stopped = 0;
  for (int i = 0; i < 300; ++i) {
    for (const PairKind kind : kKinds) {
      const FourPoints points = RandomPoints(&random, 1), velocities = RandomPoints(&random, 4);
      constexpr double kKept = 0.1;
      const double step = SafeStep(kind, points, velocities, kKept);
      const double least = kKept * Distance(kind, points);
      for (int k = 0; k <= 50; ++k) {
        EXPECT_GE(Distance(kind, points + k / 50. * step * velocities), least * (1 - 1e-12));
      }
      if (step == 1) continue;
      ++stopped;
      EXPECT_LE(Distance(kind, points + step * velocities), 1.1 * least);
    }
  }
  EXPECT_GT(stopped, 30);
}

}  // namespace
}  // namespace shapespace
