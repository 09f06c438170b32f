#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/exploration/explore.h>
#include <shapespace/exploration/space_page.h>
#include <shapespace/exploration/triangulation.h>
#include <shapespace/hierarchy/hierarchy.h>

#include "solvers/exploration/spaces.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::MadeUpSpace;
using testing::MessageOf;
using testing::Names;
using testing::Refuses;
using testing::SmallTube;
using testing::TubePoses;

std::set<std::pair<int, int>> EdgesOf(const PoseSpace& space) {
  std::set<std::pair<int, int>> edges;
  for (const auto& t : space.triangles.colwise()) {
    for (int k = 0; k < 3; ++k) edges.insert(std::minmax({t(k), t((k + 1) % 3)}));
  }
  return edges;
}

// Says that it is the first of three processes.
class OneOfThree : public ProcessPool {
 public:
  int Size() const override { return 3; }
};

TEST(ExploreSummary, CountsWhatIsInTheSpace) {
  const ShapeFamily tube = SmallTube();
  std::vector<Shape> poses = TubePoses(tube);
  for (Shape& pose : poses) pose = (3 * pose).colwise() + Eigen::Vector3d(5, -7, 11);
  ExploreOptions options;
  options.depth = 0;
  const ExploreResult coarse = Explore(tube.connectivity, poses, {}, options);
  EXPECT_TRUE(coarse.summary.levels.empty());
  EXPECT_EQ(coarse.summary.edges_not_measured, static_cast<int>(EdgesOf(coarse.space).size()));
  EXPECT_EQ(coarse.summary.solved, 6);
  options.depth = 1;
  options.threshold = 0.04;
  OneOfThree crew;
  const ExploreResult result = Explore(tube.connectivity, poses, {}, options, nullptr, &crew);
  const PoseSpace& space = result.space;
  const ExploreSummary& summary = result.summary;
  EXPECT_EQ(space.names, (std::vector<std::string>{"pose 0", "pose 1", "pose 2", "pose 3"}));
  EXPECT_LT((space.translation - Centroid(poses[0], space.metric->vertex_area)).norm(), 1e-12);
  EXPECT_EQ(summary.vertices, tube.connectivity->NumVertices());
  EXPECT_EQ(summary.triangles, tube.connectivity->NumTriangles());
  EXPECT_EQ(summary.distance_vertices, summary.vertices);
  EXPECT_EQ(summary.poses, 4);
  EXPECT_EQ(summary.nodes, static_cast<int>(space.nodes.size()));
  EXPECT_EQ(summary.cells, space.triangles.cols());
  EXPECT_EQ(summary.metric, DescribeMetric(options.geodesic.metric));
  EXPECT_EQ(summary.unit, space.metric->unit);
  EXPECT_EQ(summary.threshold, 0.04);
  EXPECT_EQ(summary.threads, NumThreads());
  EXPECT_EQ(summary.processes, 3);
  EXPECT_EQ(summary.damaged, 0);
  EXPECT_EQ(summary.found, 0);
  EXPECT_EQ(summary.not_converged, 0);
  EXPECT_TRUE(summary.Converged());
  EXPECT_EQ(summary.stress, space.stress);
  const Embedding embedding = Embed(space.distances);
  EXPECT_EQ(summary.stress, embedding.stress);
  EXPECT_EQ(summary.stress_iterations, static_cast<int>(embedding.stresses.size()) - 1);
  ASSERT_EQ(summary.levels.size(), 1u);
  const ExploreSummary::Level& level = summary.levels[0];
  const std::set<std::pair<int, int>> before = EdgesOf(coarse.space), after = EdgesOf(space);
  EXPECT_EQ(level.cells, coarse.space.triangles.cols());
  EXPECT_EQ(level.edges, static_cast<int>(before.size()));
  EXPECT_EQ(summary.solved, 6 + level.edges);
  EXPECT_EQ(level.new_nodes, static_cast<int>(space.parents.size()));
  EXPECT_EQ(summary.edges_not_measured,
            std::count_if(after.begin(), after.end(),
                          [&](const auto& edge) { return before.count(edge) == 0; }));
  for (const auto& [parent, other] : space.parents) EXPECT_LT(parent, other);
  EXPECT_GT(level.seconds, 0);
  EXPECT_LE(level.seconds, summary.refinement_seconds);
  EXPECT_GT(summary.distance_seconds, 0);
  EXPECT_GT(summary.embedding_seconds, 0);
  const double parts =
      summary.distance_seconds + summary.embedding_seconds + summary.refinement_seconds;
  EXPECT_LE(parts, summary.total_seconds);
}

TEST(Explore, OnACoarserMeshTheFinestThatIsSmallEnoughIsTaken) {
  const ShapeFamily tube = SmallTube();
  const std::vector<Shape> poses = TubePoses(tube);
  ExploreOptions options;
  options.depth = 0;
  options.geodesic.coarsest = 20;
  HierarchyOptions hierarchy_options;
  hierarchy_options.coarsest = 20;
  const Hierarchy hierarchy(tube.connectivity, poses, hierarchy_options);
  ASSERT_GE(hierarchy.NumLevels(), 3);
  for (int level = 0; level < hierarchy.NumLevels(); ++level) {
    const Connectivity& expected = *hierarchy.LevelConnectivity(level);
    options.resolution = expected.NumTriangles();
    const ExploreSummary summary = Explore(tube.connectivity, poses, {}, options).summary;
    EXPECT_EQ(summary.distance_vertices, expected.NumVertices()) << level;
    EXPECT_EQ(summary.solved, 6) << level;
  }
  options.resolution = 1;
  EXPECT_EQ(Explore(tube.connectivity, poses, {}, options).summary.distance_vertices,
            hierarchy.LevelConnectivity(0)->NumVertices());
}

TEST(Explore, WarnsOfEachThingThatIsToBeChecked) {
  const ShapeFamily tube = SmallTube();
  ExploreOptions options;
  options.depth = 0;
  options.geodesic.max_iterations = 1;
  options.embedding.max_iterations = 1;
  options.embedding.tolerance = 1e-12;
  const ExploreSummary summary = Explore(tube.connectivity, TubePoses(tube), {}, options).summary;
  EXPECT_EQ(summary.not_converged, 6);
  EXPECT_EQ(summary.stress_iterations, 1);
  EXPECT_FALSE(summary.embedded);
  EXPECT_TRUE(testing::EachNames(summary.warnings, {{"6 geodesics", "max_iterations"}, {"plane"}}));
  options = ExploreOptions();
  options.depth = 0;
  std::vector<Shape> poses = TubePoses(tube);
  poses.push_back(poses[2]);
  const ExploreSummary copies =
      Explore(tube.connectivity, poses, {"a", "b", "c", "d", "e"}, options).summary;
  EXPECT_TRUE(testing::EachNames(copies.warnings, {{"pose 4 (e)"}}));
}

// Where only positions count, poses that move one vertex each are at a simplex's corners.
TEST(Explore, WarnsIfThePlaneDoesNotReproduceTheDistances) {
  const ShapeFamily bar = MakeBar(3, 2, 1, 3, 2, 1);
  std::vector<Shape> poses(8, bar.pose(0));
  for (int k = 0; k < 8; ++k) poses[k](k % 3, 2 * k) += 0.01 * (1 + 0.05 * k);
  ExploreOptions options;
  options.depth = 0;
  MetricOptions& metric = options.geodesic.metric;
  metric.isometric = metric.strain = metric.bending = 0;
  metric.lambda = 1;
  const ExploreSummary summary = Explore(bar.connectivity, poses, {}, options).summary;
  ASSERT_GT(summary.stress, 0.2);
  const std::string stress = "stress " + std::to_string(summary.stress);
  EXPECT_TRUE(std::any_of(summary.warnings.begin(), summary.warnings.end(),
                          [&](const auto& one) { return testing::HasWord(one, stress); }));
}

TEST(Explore, BadPosesAndOptionsAreNamed) {
  const ShapeFamily tube = SmallTube();
  const std::vector<Shape> poses = TubePoses(tube);
  const auto of_poses = [&](const std::vector<Shape>& given) {
    return MessageOf<MeshError>([&] { DistanceMatrix(tube.connectivity, given); });
  };
  EXPECT_TRUE(Names(of_poses({poses[0]}), {"two poses"}));
  EXPECT_TRUE(Names(of_poses({poses[0], poses[1], poses[2].leftCols(5)}), {"pose 2"}));
  std::vector<Shape> spoilt = poses;
  spoilt[1](2, 3) = std::nan("");
  EXPECT_TRUE(Names(of_poses(spoilt), {"pose 1"}));
  const auto accepts = [](const auto& change) {
    ExploreOptions options;
    change(&options);
    return MessageOf<InvalidOptions>([&] { options.Validate(); });
  };
  EXPECT_EQ(accepts([](auto* o) { o->depth = 10; }), "nothing was thrown");
  EXPECT_TRUE(Names(accepts([](auto* o) { o->depth = 11; }), {"depth:", "0", "10"}));
  EXPECT_EQ(accepts([](auto* o) { o->resolution = 0; }), "nothing was thrown");
  EXPECT_TRUE(Names(accepts([](auto* o) { o->threshold = HUGE_VAL; }), {"threshold:"}));
  EXPECT_TRUE(Names(accepts([](auto* o) { o->threshold = -0.1; }), {"threshold:"}));
  EXPECT_NE(accepts([](auto* o) { o->embedding.max_iterations = 0; }), "nothing was thrown");
  EXPECT_NE(accepts([](auto* o) { o->geodesic.tolerance = 0; }), "nothing was thrown");
  EXPECT_TRUE(Refuses<InvalidOptions>(
      [&] {
        Explore(tube.connectivity, poses, {"a", "b", "c"});
      },
      {"names:"}));
}

// Of more samples the first are the same, so that each deviation can be told.
TEST(MeasureBlends, MeanGreatestAndShareAreThoseOfTheSamples) {
  const ShapeFamily tube = SmallTube();
  ExploreOptions options;
  options.depth = 0;
  PoseSpace space = Explore(tube.connectivity, TubePoses(tube), {}, options).space;
  std::vector<double> shares;
  double sum = 0;
  for (int count = 1; count <= 4; ++count) {
    const BlendErrors errors = MeasureBlends(space, count, options);
    EXPECT_EQ(errors.samples, count);
    EXPECT_EQ(errors.vertices, tube.connectivity->NumVertices());
    shares.push_back(errors.mean * count - sum);
    sum += shares.back();
    EXPECT_NEAR(errors.max, *std::max_element(shares.begin(), shares.end()), 1e-10) << count;
  }
  std::vector<double> sorted = shares;
  std::sort(sorted.begin(), sorted.end());
  ASSERT_GT(sorted[0], 0);
  options.threshold = (sorted[2] + sorted[3]) / 2;
  EXPECT_EQ(MeasureBlends(space, 4, options).within, 0.75);
  options.threshold = sorted[3] * 1.01;
  EXPECT_EQ(MeasureBlends(space, 4, options).within, 1);
  // They are shares of the greatest distance.
  space.distances(1, 3) = space.distances(3, 1) = 5 * space.distances.maxCoeff();
  EXPECT_NEAR(MeasureBlends(space, 4, options).mean, sum / 4 / 5, 1e-12);
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { MeasureBlends(space, 0); }, {"samples:", "1"}));
}

TEST(MeasureBlends, OnALineToo) {
  const ShapeFamily tube = SmallTube();
  ExploreOptions options;
  options.depth = 0;
  const std::vector<Shape> poses = {tube.pose(0), tube.pose(100)};
  const PoseSpace coarse = Explore(tube.connectivity, poses, {}, options).space;
  options.depth = 2;
  const PoseSpace fine = Explore(tube.connectivity, poses, {}, options).space;
  ASSERT_GE(fine.segments.cols(), 3);
  const BlendErrors before = MeasureBlends(coarse, 5, options);
  const BlendErrors after = MeasureBlends(fine, 5, options);
  EXPECT_GT(before.mean, 0);
  EXPECT_LT(after.mean, 0.5 * before.mean);
}

TEST(PageOf, ShowsTheWholeSpace) {
  PoseSpace space = MadeUpSpace(SmallTube());
  space.segments = Eigen::Vector2i(1, 3);
  space.appearance.vertex_colours =
      Eigen::MatrixXd::Constant(3, space.metric->connectivity->NumVertices(), 0.5);
  const PageSpace page = PageOf(space, "herd");
  EXPECT_EQ(page.connectivity, space.metric->connectivity);
  ASSERT_EQ(page.nodes.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(page.nodes[i], space.Placed(i));
  EXPECT_EQ(page.names, space.names);
  EXPECT_EQ(page.points, space.points);
  EXPECT_EQ(page.triangles, space.triangles);
  EXPECT_EQ(page.segments, space.segments);
  EXPECT_EQ(page.parents, space.parents);
  EXPECT_EQ(page.vertex_colours, space.appearance.vertex_colours);
  EXPECT_EQ(page.name, "herd");
}

}  // namespace
}  // namespace shapespace
