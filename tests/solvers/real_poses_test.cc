// Geodesics between real poses; skipped if they are missing.

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/files/read.h>
#include <shapespace/geodesic/geodesic.h>

namespace shapespace {
namespace {

struct RealPair {
  const char *first, *last;
  double rms, roughness, folds, ratio;  // upper bounds for the path
};

void PrintTo(const RealPair& pair, std::ostream* out) { *out << pair.first << ' ' << pair.last; }

class RealPoses : public ::testing::TestWithParam<RealPair> {};

// Bounds are a fifth above the values measured with the default options, 15 shapes.
TEST_P(RealPoses, PathIsAsGoodAsMeasured) {
  const std::filesystem::path folder = SHAPESPACE_DATA_DIR;
  const RealPair& pair = GetParam();
  const std::string first = (folder / pair.first).string(), last = (folder / pair.last).string();
  if (folder.empty() || !std::filesystem::exists(first)) {
    GTEST_SKIP() << "no real meshes: set the CMake cache path SHAPESPACE_DATA_DIR";
  }
  const auto [path, summary] = Interpolate(ReadPoses({first, last}));
  EXPECT_EQ(summary.termination, Termination::kConverged) << summary.FullReport();
  EXPECT_LT(summary.quality.edge_rms, pair.rms) << summary.FullReport();
  EXPECT_LT(summary.quality.roughness, pair.roughness);
  EXPECT_LE(summary.quality.folds, pair.folds);
  EXPECT_LT(summary.Ratio(), pair.ratio);
  EXPECT_LT(summary.quality.speed_max, 1.15);  // no part rests and then jumps
}

INSTANTIATE_TEST_SUITE_P(
    , RealPoses,
    ::testing::Values(RealPair{"finger/0.obj", "finger/1.obj", 0.0012, 0.11, 0, 1.01},
                      RealPair{"plate/rolledA.obj", "plate/rolledB.obj", 0.0028, 1.7, 0, 1.5},
                      RealPair{"leaf/original.obj", "leaf/bend0.obj", 1e-6, 1e-4, 0, 1.001},
                      RealPair{"hand/rest.obj", "hand/curl65.obj", 0.0033, 0.41, 0, 1.01},
                      RealPair{"human/000.obj", "human/007.obj", 0.0115, 2.4, 3, 1.08},
                      RealPair{"horse/reference.obj", "horse/01.obj", 0.0095, 2.7, 3, 1.06},
                      RealPair{"cat/reference.obj", "cat/01.obj", 0.03, 9.6, 12, 1.25}),
    [](const auto& info) {
      return std::filesystem::path(info.param.first).parent_path().string();
    });

// Under edge lengths a part turns over, which with 15 shapes alone takes a single segment, at 2 %
// more energy.
TEST(RealPosesThatTurnOver, MoveEvenly) {
  const std::filesystem::path folder = SHAPESPACE_DATA_DIR;
  const std::string first = (folder / "cat/04.obj").string();
  const std::string last = (folder / "cat/02.obj").string();
  if (folder.empty() || !std::filesystem::exists(first)) {
    GTEST_SKIP() << "no real meshes: set the CMake cache path SHAPESPACE_DATA_DIR";
  }
  GeodesicOptions options;
  options.metric = MetricOptions::Isometric();
  int removed = 0;
  for (const std::vector<std::string>& pair :
       {std::vector<std::string>{first, last}, std::vector<std::string>{last, first}}) {
    const auto [path, summary] = Interpolate(ReadPoses(pair), options);
    EXPECT_EQ(summary.termination, Termination::kConverged) << summary.FullReport();
    EXPECT_LT(summary.quality.speed_max, 1.1) << summary.FullReport();
    // Two solves remove a jump, the last of the table: more shapes, then as many as were asked for.
    ASSERT_GE(summary.levels.size(), 3u);
    const GeodesicSummary::Level* const end = &summary.levels.back();
    if (end[-1].shapes < end->shapes) continue;
    ++removed;
    EXPECT_TRUE(end->kept);
    EXPECT_EQ(end[-2].shapes, end->shapes);
    EXPECT_LT(end->energy, end[-2].energy);
  }
  EXPECT_GE(removed, 1) << "neither path jumped at first: choose other poses for this test";
}

// The forearms pass through the body, from behind to the front.
TEST(RealPosesThatCross, AreWarnedOf) {
  const std::filesystem::path folder = SHAPESPACE_DATA_DIR;
  const std::string first = (folder / "scape/5.obj").string();
  if (folder.empty() || !std::filesystem::exists(first)) {
    GTEST_SKIP() << "no real meshes: set the CMake cache path SHAPESPACE_DATA_DIR";
  }
  const auto [path, summary] = Interpolate(ReadPoses({first, (folder / "scape/6.obj").string()}));
  EXPECT_GT(summary.intersections, 20);
  const std::string report = summary.FullReport();
  EXPECT_NE(report.find("Warning: the body intersects itself"), std::string::npos) << report;
}

}  // namespace
}  // namespace shapespace
