// What levels hold and how they are made, against values worked out in other ways.

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/hierarchy/detail/decimate.h>
#include <shapespace/hierarchy/hierarchy.h>

#include "hierarchy/meshes.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;
using testing::Noise;
using testing::PosedMesh;

HierarchyOptions DownTo(int triangles) {
  HierarchyOptions options;
  options.coarsest = triangles;
  return options;
}

// Of a closed surface, whose collapses remove two triangles each.
TEST(Hierarchy, LevelsHaveAQuarterAsLongAsTheNextHasAtLeastHalfOfTheRest) {
  const ShapeFamily bar = MakeBar(1, 1, 2, 5, 5, 10);
  ASSERT_EQ(bar.connectivity->NumTriangles(), 500);
  const Shape pose = bar.pose(0) + Noise(bar.connectivity->NumVertices(), 1e-3, 1);
  const std::vector<std::pair<int, std::vector<int>>> cases = {
      {62, {62, 124, 500}}, {63, {62, 500}}, {250, {250, 500}}, {251, {500}}, {125, {124, 500}}};
  for (const auto& [coarsest, expected] : cases) {
    const Hierarchy hierarchy(bar.connectivity, {pose}, DownTo(coarsest));
    std::vector<int> found;
    for (int level = 0; level < hierarchy.NumLevels(); ++level) {
      found.push_back(hierarchy.LevelConnectivity(level)->NumTriangles());
    }
    EXPECT_EQ(found, expected) << coarsest;
    EXPECT_FALSE(hierarchy.StoppedEarly());
  }
}

// The barycentric weights of the vertices of level `level` + 1, one row each: a shape without
// details is lifted to the mean of its vertices.
Eigen::MatrixXd WeightsOf(const Hierarchy& hierarchy, int level) {
  const int coarse = static_cast<int>(hierarchy.Vertices(level).size());
  const int fine = static_cast<int>(hierarchy.Vertices(level + 1).size());
  const Shape nothing = Shape::Zero(3, fine), base = Shape::Zero(3, coarse);
  Eigen::MatrixXd weights(fine, coarse);
  for (int c = 0; c < coarse; c += 3) {
    Shape units = Shape::Zero(3, coarse);
    for (int k = 0; k < 3 && c + k < coarse; ++k) units(k, c + k) = 1;
    const Shape lifted = hierarchy.Lift(units, level, base, nothing, base, nothing, 0.25);
    for (int k = 0; k < 3 && c + k < coarse; ++k) weights.col(c + k) = lifted.row(k).transpose();
  }
  return weights;
}

struct TubeLevels {
  PosedMesh tube = testing::BentTube(1500);
  Hierarchy hierarchy{tube.connectivity, tube.poses, DownTo(90)};
};

TEST(RestrictField, IsTheGeometricMeanWithTheWeightsOfAllLevels) {
  const TubeLevels levels;
  const Hierarchy& hierarchy = levels.hierarchy;
  ASSERT_EQ(hierarchy.NumLevels(), 3);
  const int count = levels.tube.connectivity->NumVertices();
  const Eigen::VectorXd field = Noise(count, 1, 3).row(0).transpose().array().exp();
  EXPECT_TRUE(hierarchy.RestrictField(field, 2).isApprox(field, 1e-12));
  Eigen::VectorXd numbers = Eigen::VectorXd::Ones(count), logarithms = field.array().log();
  for (int level = 1; level >= 0; --level) {
    const Eigen::MatrixXd weights = WeightsOf(hierarchy, level);
    EXPECT_GT(weights.minCoeff(), -1e-12);
    EXPECT_LT((weights.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-12);
    numbers = weights.transpose() * numbers.eval();
    logarithms = weights.transpose() * logarithms.eval();
    const Eigen::VectorXd expected = (logarithms.array() / numbers.array()).exp();
    EXPECT_TRUE(hierarchy.RestrictField(field, level).isApprox(expected, 1e-10)) << level;
  }
}

// In a plane that grows by a factor s the gradient is I + d, d = diag(d1, d2, 0), where the sum of
// 0.1 d / (s - 1 - d) over both is 1: the edges' share of each direction and a tenth of their sum.
TEST(Hierarchy, GradientsOfAPlaneThatGrowsFollowItsEdgesAndKeepItsNormal) {
  const Soup grid = testing::Grid(14, 14);
  Shape shape = grid.vertices + Noise(grid.NumVertices(), 0.1, 5);
  shape.row(2).setZero();
  const auto connectivity = testing::ConnectivityOf(grid);
  const Hierarchy hierarchy(connectivity, {shape}, DownTo(60));
  ASSERT_GT(hierarchy.NumLevels(), 1);
  const Shape base = hierarchy.Restrict(shape, 0);
  const double s = 1.5;
  const std::vector<Eigen::Matrix3d> gradients = hierarchy.LiftGradients(s * base, 0, base);
  const std::vector<int>&fine = hierarchy.Vertices(1), &coarse = hierarchy.Vertices(0);
  ASSERT_EQ(gradients.size(), fine.size());
  int kept = 0;
  for (size_t v = 0; v < fine.size(); ++v) {
    const Eigen::Matrix3d& gradient = gradients[v];
    EXPECT_NEAR(gradient(2, 2), 1, 1e-9);
    EXPECT_NEAR(gradient(0, 1), gradient(1, 0), 1e-9);
    const Eigen::Matrix2d in_plane = gradient.topLeftCorner<2, 2>();
    EXPECT_LT(in_plane.operatorNorm(), s);
    EXPECT_GT(in_plane.determinant(), 1.2);
    if (!std::binary_search(coarse.begin(), coarse.end(), fine[v])) continue;
    ++kept;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(in_plane);
    double sum = 0;
    for (const double value : solver.eigenvalues()) sum += 0.1 * (value - 1) / (s - value);
    EXPECT_NEAR(sum, 1, 1e-7);
  }
  EXPECT_EQ(kept, static_cast<int>(coarse.size()));
}

// The gradient follows a rotation that comes after.
TEST(Hierarchy, GradientsTurnWithTheCoarseShape) {
  const TubeLevels levels;
  const Shape base = levels.hierarchy.Restrict(levels.tube.poses[0], 0);
  const Shape bent = levels.hierarchy.Restrict(levels.tube.poses[1], 0);
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()));
  const auto plain = levels.hierarchy.LiftGradients(bent, 0, base);
  const auto turned =
      levels.hierarchy.LiftGradients((turn * bent).colwise() + Eigen::Vector3d(5, 6, 7), 0, base);
  for (size_t v = 0; v < plain.size(); ++v) {
    EXPECT_LT((turned[v] - turn * plain[v]).norm(), 1e-8) << v;
  }
}

// The cost of a collapse of v onto w: the squared distances of w from the planes of v's triangles,
// weighted by a third of their areas, and a hundredth of the fourth power of the length, in all
// poses, each scaled to the area 1. The first is the cheapest that keeps normals within 60 degrees
// and makes no sliver.
TEST(PlanCollapses, TheFirstCollapseIsTheCheapest) {
  const ShapeFamily bar = MakeBar(1, 1, 2, 2, 2, 4);
  const Connectivity& mesh = *bar.connectivity;
  const int count = mesh.NumVertices();
  ASSERT_LT(count, 200);
  for (int seed = 0; seed < 12; ++seed) {
    std::vector<Shape> poses, scaled;
    for (int p = 0; p < 2; ++p) {
      Shape pose = bar.pose(0);
      pose.colwise().normalize();  // round, and then of different sizes
      pose += Noise(count, 0.08, 2 * seed + p);
      poses.push_back((p == 0 ? 3 : 0.2) * pose);
      double area = 0;
      for (const Eigen::Vector3i t : mesh.Triangles().colwise()) {
        const Eigen::Vector3d u = poses[p].col(t(1)) - poses[p].col(t(0));
        area += u.cross(poses[p].col(t(2)) - poses[p].col(t(0))).norm() / 2;
      }
      scaled.push_back(poses[p] / std::sqrt(area));
    }
    std::vector<std::tuple<double, int, int>> costs;
    for (const Eigen::Vector2i edge : mesh.Edges().colwise()) {
      for (const auto& [v, w] : {std::pair(edge(0), edge(1)), std::pair(edge(1), edge(0))}) {
        double cost = 0;
        bool possible = true;
        for (const Shape& pose : scaled) {
          const Eigen::Vector3d way = pose.col(w) - pose.col(v);
          cost += 0.01 * std::pow(way.norm(), 4);
          for (const int f : mesh.TrianglesOfVertices()[v]) {
            Eigen::Matrix3d corners = pose(Eigen::all, mesh.Triangles().col(f));
            const auto normal = [&] {
              return Eigen::Vector3d(
                  (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0)));
            };
            const Eigen::Vector3d before = normal();
            cost += before.norm() / 6 * std::pow(before.normalized().dot(way), 2);
            if ((mesh.Triangles().col(f).array() == w).any()) continue;
            for (int k = 0; k < 3; ++k) {
              if (mesh.Triangles()(k, f) == v) corners.col(k) = pose.col(w);
            }
            const Eigen::Vector3d after = normal();
            double squares = 0;
            for (int k = 0; k < 3; ++k) {
              squares += (corners.col(k) - corners.col((k + 1) % 3)).squaredNorm();
            }
            possible = possible && before.normalized().dot(after.normalized()) > 0.5 &&
                       2 * std::sqrt(3.0) * after.norm() / squares > 0.2;
          }
        }
        if (possible) costs.emplace_back(cost, v, w);
      }
    }
    std::sort(costs.begin(), costs.end());
    const std::vector<internal::Collapse> plan =
        internal::PlanCollapses(mesh, poses, mesh.NumTriangles() - 2);
    ASSERT_EQ(plan.size(), 1u);
    EXPECT_EQ(plan[0].from, std::get<1>(costs[0])) << seed;
    EXPECT_EQ(plan[0].to, std::get<2>(costs[0])) << seed;
    EXPECT_EQ(plan[0].triangles, mesh.NumTriangles() - 2);
  }
}

// Reports how many of all triangles to remove have gone.
class Counts final : public Progress {
 public:
  bool Report(const std::string& stage, int done, int total) override {
    stages.push_back(stage);
    reports.emplace_back(done, total);
    return true;
  }
  std::vector<std::string> stages;
  std::vector<std::pair<int, int>> reports;
};

TEST(PlanCollapses, ReportsHowManyOfTheTrianglesToRemoveHaveGone) {
  const PosedMesh mesh = testing::BentTube(1000);
  const int total = mesh.connectivity->NumTriangles() - 300;
  Counts counts;
  internal::PlanCollapses(*mesh.connectivity, mesh.poses, 300, {}, &counts);
  ASSERT_GT(counts.reports.size(), 2u);
  EXPECT_EQ(counts.stages.front(), "decimating");
  EXPECT_EQ(counts.reports.front(), std::make_pair(0, total));
  EXPECT_EQ(counts.reports.back().second, total);
  EXPECT_GT(counts.reports.back().first, 0);
  EXPECT_LT(counts.reports.back().first, total);
}

TEST(Hierarchy, MessagesSayWhatIsWrongWithThePoses) {
  const PosedMesh tube = testing::BentTube(100);
  const auto message = [&](const std::vector<Shape>& poses) {
    return MessageOf<MeshError>([&] { Hierarchy(tube.connectivity, poses); });
  };
  EXPECT_TRUE(Names(message({}), {"one pose"}));
  EXPECT_TRUE(Names(message({tube.poses[0], Shape::Zero(3, 5)}), {"vertices"}));
  EXPECT_EQ(message(tube.poses), "nothing was thrown");
  EXPECT_NO_THROW(DownTo(4).Validate());
}

}  // namespace
}  // namespace shapespace
