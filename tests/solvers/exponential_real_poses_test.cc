// Shooting on real meshes; skipped if they are missing.

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include <shapespace/exponential/exponential.h>
#include <shapespace/files/read.h>

#include "support/motions.h"

namespace shapespace {
namespace {

struct RoundTripPair {
  const char *first, *last;
  double error = 0;  // bound of a round trip, as a share of the diameter
};

void PrintTo(const RoundTripPair& pair, std::ostream* out) {
  *out << pair.first << ' ' << pair.last;
}

std::string NameOf(const ::testing::TestParamInfo<RoundTripPair>& info) {
  return std::filesystem::path(info.param.first).parent_path().string();
}

class ExponentialRealPoses : public ::testing::TestWithParam<RoundTripPair> {
 protected:
  void SetUp() override {
    const std::filesystem::path folder = SHAPESPACE_DATA_DIR;
    const std::string first = (folder / GetParam().first).string();
    if (folder.empty() || !std::filesystem::exists(first)) {
      GTEST_SKIP() << "no real meshes: set the CMake cache path SHAPESPACE_DATA_DIR";
    }
    poses_ = ReadPoses({first, (folder / GetParam().last).string()});
  }

  Poses poses_;
};

using RoundTrip = ExponentialRealPoses;

// The accuracy depends on that of the path: see exponential_test.cc on tolerances. The horse's
// L-BFGS ends where rounding hides the remaining gain. When the path is solved by the trust region,
// which takes a minute, the round trip is accurate to 1e-9 of the diameter.
TEST_P(RoundTrip, ReturnsThePath) {
  GeodesicOptions options;
  options.tolerance = 1e-15;
  options.max_iterations = 5000;
  const Path path = Interpolate(poses_, options).path;
  const auto [again, summary] = Extrapolate(FirstShapes(path, 2), path.NumShapes() - 2);
  EXPECT_TRUE(summary.Converged()) << summary.FullReport();
  double largest = 0;
  for (int i = 0; i < again.NumShapes(); ++i) {
    largest = std::max(largest, testing::Distance(again.shapes[i], path.shapes[i]));
  }
  EXPECT_EQ(again.NumShapes(), path.NumShapes());
  EXPECT_LT(largest, GetParam().error * testing::Diameter(path.shapes[0]));
}

INSTANTIATE_TEST_SUITE_P(, RoundTrip,
                         ::testing::Values(RoundTripPair{"finger/0.obj", "finger/1.obj", 1e-6},
                                           RoundTripPair{"horse_lowpoly/base.obj",
                                                         "horse_lowpoly/m03.obj", 3e-6},
                                           RoundTripPair{"hand/rest.obj", "hand/curl30.obj", 1e-6}),
                         NameOf);

using Inverse = ExponentialRealPoses;

TEST_P(Inverse, TheExponentialMapUndoesTheLogarithm) {
  const auto metric = FreezeMetric({}, poses_.connectivity, poses_.shapes);
  const Shape &from = poses_.shapes[0], &to = poses_.shapes[1];
  const Shape end = Exponential(metric, from, Logarithm(metric, from, to));
  EXPECT_LT(testing::Distance(end, FitRigidMotion(to, from, metric->vertex_area)(to)),
            GetParam().error * testing::Diameter(to));
}

INSTANTIATE_TEST_SUITE_P(, Inverse,
                         ::testing::Values(RoundTripPair{"finger/0.obj", "finger/1.obj", 1e-5},
                                           RoundTripPair{"horse_lowpoly/base.obj",
                                                         "horse_lowpoly/m03.obj", 1e-5},
                                           RoundTripPair{"hand/rest.obj", "hand/curl30.obj", 1e-5}),
                         NameOf);

using Continuation = ExponentialRealPoses;

// An extrapolation of the path's own length, at the path's default tolerance.
TEST_P(Continuation, KeepsGoing) {
  const Path path = Interpolate(poses_).path;
  const auto [longer, summary] = Extrapolate(path, path.NumShapes() - 1);
  EXPECT_EQ(summary.ending, ExponentialSummary::Ending::kComplete) << summary.FullReport();
  EXPECT_EQ(longer.NumShapes(), 2 * path.NumShapes() - 1);
  for (const Shape& shape : longer.shapes) EXPECT_TRUE(shape.allFinite());
  for (const ExponentialSummary::Step& step : summary.steps) EXPECT_LE(step.inverted, 0.01);
  // Detail that was lifted from a coarser mesh must not acquire a motion of its own.
  for (const ExponentialSummary::Step& step : summary.steps) {
    if (step.vertices < summary.vertices) continue;
    EXPECT_NEAR(step.energy / summary.steps.front().energy, 1, 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(, Continuation,
                         ::testing::Values(RoundTripPair{"finger/0.obj", "finger/1.obj"},
                                           RoundTripPair{"hand/rest.obj", "hand/curl30.obj"}),
                         NameOf);

using StrainContinuation = ExponentialRealPoses;

// Under strain every step has a root on the mesh itself, also with slivers and folded hinges, and
// the constant energy shows that nothing turns over on the way to it.
TEST_P(StrainContinuation, StaysOnTheMesh) {
  GeodesicOptions options;
  options.metric = MetricOptions::Strain();
  options.tolerance = 1e-6;
  const Path path = Interpolate(poses_, options).path;
  const ExponentialSummary summary = Extrapolate(path, path.NumShapes() - 1).summary;
  EXPECT_TRUE(summary.Converged()) << summary.FullReport();
  for (const ExponentialSummary::Step& step : summary.steps) {
    EXPECT_NEAR(step.energy / summary.steps.front().energy, 1, 1e-2);
  }
}

INSTANTIATE_TEST_SUITE_P(, StrainContinuation,
                         ::testing::Values(RoundTripPair{"human/000.obj", "human/007.obj"},
                                           RoundTripPair{"cat/reference.obj", "cat/01.obj"}),
                         NameOf);

}  // namespace
}  // namespace shapespace
