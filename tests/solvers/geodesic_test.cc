#include <shapespace/geodesic/geodesic.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/body.h>
#include <shapespace/bodies/bricard.h>
#include <shapespace/bodies/catenoid.h>
#include <shapespace/bodies/miura.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/skinned.h>
#include <shapespace/bodies/steffen.h>
#include <shapespace/path/energy.h>

#include "support/features.h"
#include "support/listener.h"
#include "support/message_of.h"
#include "support/motions.h"
#include "support/paths.h"

namespace shapespace {
namespace {

using testing::Diameter;
using testing::Distance;
using testing::Listener;
using testing::Rotation;

GeodesicOptions Options(int shapes, double tolerance) {
  GeodesicOptions options;
  options.shapes = shapes;
  options.tolerance = tolerance;
  options.max_iterations = 3000;
  return options;
}

// Each preview is a whole path, valid and nearer to the solution than the one before in the same
// piece, and that there are previews changes nothing.
TEST(Interpolate, PreviewsAreWholePathsThatBecomeFiner) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 32, 6, 6);
  const std::vector<Shape> poses = {bar.pose(0), bar.pose(150), bar.pose(30)};
  GeodesicOptions options = Options(7, 1e-5);
  const GeodesicResult expected = Interpolate(bar.connectivity, poses, options);
  ASSERT_GT(expected.summary.hierarchy.size(), 1u);
  std::vector<std::vector<double>> energies;  // of both pieces, of each preview
  options.preview = [&](const Path& so_far) {
    so_far.Validate();
    ASSERT_EQ(so_far.parameters, expected.path.parameters);
    EXPECT_EQ(so_far.poses, expected.path.poses);
    for (const int pose : so_far.poses) {
      EXPECT_EQ(so_far.shapes[pose], expected.path.shapes[pose]);
    }
    const std::vector<double> lengths = SquaredLengths(so_far.metric, so_far.shapes);
    const auto middle = lengths.begin() + so_far.poses[1];
    energies.push_back({std::accumulate(lengths.begin(), middle, 0.0),
                        std::accumulate(middle, lengths.end(), 0.0)});
  };
  const GeodesicResult result = Interpolate(bar.connectivity, poses, options);
  EXPECT_EQ(result.path.shapes, expected.path.shapes);
  ASSERT_GE(energies.size(), 4u);
  for (size_t i = 1; i < energies.size(); ++i) {
    for (int piece = 0; piece < 2; ++piece) {
      EXPECT_LE(energies[i][piece], 1.001 * energies[i - 1][piece]) << i << ", piece " << piece;
    }
  }
  // The first is better than the blend that the second piece begins as.
  EXPECT_LT(energies.back()[1], 0.5 * energies.front()[1]);
}

// A vertex of no element, without a cost of position, has no cost however it moves.
TEST(Interpolate, VerticesThatCostNothingMoveStraight) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 24, 4, 4);
  const int count = bar.connectivity->NumVertices();
  std::vector<int> begin, corners;
  for (const auto& triangle : bar.connectivity->Triangles().colwise()) {
    begin.push_back(static_cast<int>(corners.size()));
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  begin.push_back(static_cast<int>(corners.size()));
  const auto mesh = Connectivity::Make(count + 1, begin, corners);
  std::vector<Shape> poses;
  for (const double bend : {0.0, 60.0, 20.0}) {
    poses.emplace_back(3, count + 1);
    poses.back() << bar.pose(bend), Eigen::Vector3d(bend / 10, 3, -bend / 5);
  }
  GeodesicOptions options = Options(7, 1e-6);
  options.metric.lambda = 0;
  for (const GeodesicStart start : {GeodesicStart::kBest, GeodesicStart::kFirst}) {
    options.start = start;
    const Path path = Interpolate(mesh, poses, options).path;
    for (int i = 0; i < path.NumShapes(); ++i) {
      const int piece = i < 8 ? 0 : 1;
      const double t = i / 8.0 - piece;
      const Eigen::Vector3d from = path.shapes[path.poses[piece]].col(count);
      const Eigen::Vector3d to = path.shapes[path.poses[piece + 1]].col(count);
      EXPECT_LT((path.shapes[i].col(count) - (1 - t) * from - t * to).norm(), 1e-12) << i;
    }
  }
}

// Where the first start comes near to the lower bound, the others have nothing to gain.
TEST(Interpolate, TriesOtherStartsOnlyWhereTheFirstIsNotGood) {
  const auto other_starts = [](const ShapeFamily& body, double from, double to) {
    const GeodesicSummary summary =
        Interpolate(body.connectivity, {body.pose(from), body.pose(to)}, Options(3, 1e-4)).summary;
    std::set<std::string> names;
    for (const GeodesicSummary::Level& level : summary.levels) names.insert(level.start);
    EXPECT_EQ(names.count("blend"), 1u);
    return names.count("first") + names.count("last");
  };
  EXPECT_EQ(other_starts(MakeBody("tube", 300), 0, 20), 0u);
  const ShapeFamily fold = MakeBody("miura");
  EXPECT_GT(other_starts(fold, fold.begin, fold.end), 0u);
}

TEST(Interpolate, TranslatesAlongAStraightLine) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  const Shape first = bar.pose(50);
  const Eigen::Vector3d way(3, -40, 7);
  for (const MetricOptions& metric :
       {MetricOptions::Isometric(), MetricOptions::Rigid(), MetricOptions::Paper()}) {
    GeodesicOptions options = Options(3, 1e-8);
    options.metric = metric;
    const auto [path, summary] =
        Interpolate(bar.connectivity, {first, first.colwise() + way}, options);
    EXPECT_EQ(summary.termination, Termination::kConverged);
    for (int i = 0; i <= 4; ++i) {
      const Shape expected = first.colwise() + i / 4.0 * way;
      EXPECT_LT((path.Placed(i) - expected).cwiseAbs().maxCoeff(), 1e-11);
    }
  }
}

// Also by 179 degrees, for which the linear blend of the poses without alignment would collapse.
TEST(Interpolate, TurnsARigidCopyAtConstantSpeedAndKeepsItsShape) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  const Shape first = bar.pose(50);
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 1, 0.2).normalized();
  for (double degrees : {60.0, 179.0}) {
    GeodesicOptions options = Options(5, 1e-8);
    options.metric.lambda = 0;
    const auto [path, summary] =
        Interpolate(bar.connectivity, {first, Rotation(degrees, axis) * first}, options);
    EXPECT_LT(summary.energy, 1e-20);
    EXPECT_LT(summary.quality.first_max, 1e-10);
    const Eigen::Vector3d centre = Centroid(first, path.metric->vertex_area);
    for (int i = 0; i <= 6; ++i) {
      const Shape expected = Rotation(i / 6.0 * degrees, axis) * (first.colwise() - centre);
      const Shape placed = path.Placed(i);
      const Shape centred = placed.colwise() - Centroid(placed, path.metric->vertex_area);
      EXPECT_LT((centred - expected).cwiseAbs().maxCoeff(), 1e-9);
    }
  }
}

TEST(Interpolate, IsTheLinearBlendOfAlignedPosesInAFlatMetric) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  GeodesicOptions options = Options(7, 1e-12);
  options.metric.strain = options.metric.bending = 0;
  options.metric.lambda = 1;
  const auto [path, summary] = Interpolate(bar.connectivity, {bar.pose(0), bar.pose(90)}, options);
  for (int i = 0; i <= 8; ++i) {
    const double t = i / 8.0;
    const Shape blend = (1 - t) * path.shapes.front() + t * path.shapes.back();
    EXPECT_LT((path.shapes[i] - blend).cwiseAbs().maxCoeff(), 1e-9);
  }
  EXPECT_NEAR(summary.Ratio(), 1, 1e-9);
}

// An edge that only grows: ds^2 = (w r^2 + lambda / 8) dr^2 with A_p = 1/2, so t is the normalised
// arc length, in closed form. The discretisation is of second order.
TEST(Interpolate, StretchesASingleEdgeAsTheClosedFormSays) {
  Shape first = Shape::Zero(3, 2), last = Shape::Zero(3, 2);
  first(0, 1) = 1;
  last(0, 1) = 4;
  double previous = 0;
  for (int shapes : {7, 15, 31}) {
    GeodesicOptions options = Options(shapes, 1e-15);
    options.metric = MetricOptions::Isometric();
    options.metric.lambda = 3;  // of the magnitude of the other part, so that both matter
    const auto [path, summary] = Interpolate(testing::SingleEdge(), {first, last}, options);
    const double unit = path.metric->unit;
    const double w = testing::Get<EdgeLength>(*path.metric).weights(0);
    const double c = 3 / 4.0 / w;  // lambda (A_p / 4 + A_q / 4) / w
    const auto arc = [&](double r) {
      return 0.5 * (r * std::sqrt(r * r + c) + c * std::asinh(r / std::sqrt(c)));
    };
    double error = 0;
    for (int i = 0; i < path.NumShapes(); ++i) {
      const double r = (path.shapes[i].col(1) - path.shapes[i].col(0)).norm();
      const double begin = arc(1 / unit), end = arc(4 / unit);
      error = std::max(error, std::abs((arc(r) - begin) / (end - begin) - path.parameters[i]));
    }
    EXPECT_LT(error, 1e-3);
    if (previous > 0) {
      EXPECT_NEAR(previous / error, 4, 0.4) << shapes;
    }
    previous = error;
  }
}

TEST(Interpolate, FollowsExactIsometricFlexes) {
  for (const ShapeFamily& body : {MakeStrip(1, 1, 16), MakeBricard(), MakeSteffen()}) {
    SCOPED_TRACE(body.name);
    GeodesicOptions options = Options(15, 1e-10);
    options.solver = GeodesicSolver::kTrustRegion;  // takes a tenth of the iterations of L-BFGS
    options.metric.bending = 0;
    double deviation[2];
    for (int i = 0; i < 2; ++i) {
      options.metric.lambda = i == 0 ? 1e-3 : 1e-4;
      const auto [path, summary] =
          Interpolate(body.connectivity, {body.pose(0), body.pose(0.7 * body.end)}, options);
      EXPECT_EQ(summary.termination, Termination::kConverged);
      deviation[i] = summary.quality.edge_max;
    }
    EXPECT_LT(deviation[0], 1e-2);
    EXPECT_NEAR(deviation[0] / deviation[1], 10, 4);  // proportional to lambda
  }
}

// A flat parallelogram with stiff sides and diagonals can still twist by any small angle x while
// lengths change by x^2 only. The gain is proportional to lambda x and the cost to x^4, so the
// deviation x^2 is proportional to lambda^(2/3).
TEST(Interpolate, FoldsAMiuraSheetWithItsParallelogramsNearlyFlat) {
  const ShapeFamily body = MakeMiura(1, 1, 60, 3, 3);
  GeodesicOptions options = Options(15, 1e-10);
  options.solver = GeodesicSolver::kTrustRegion;
  options.metric.bending = 0;
  double deviation[2];
  for (int i = 0; i < 2; ++i) {
    options.metric.lambda = i == 0 ? 1e-6 : 1e-7;
    const auto [path, summary] =
        Interpolate(body.connectivity, {body.pose(20), body.pose(60)}, options);
    EXPECT_EQ(summary.termination, Termination::kConverged);
    deviation[i] = summary.quality.edge_max;
  }
  EXPECT_LT(deviation[0], 1e-5);
  EXPECT_NEAR(deviation[0] / deviation[1], std::pow(10, 2.0 / 3), 0.5);
}

// The associate family of the catenoid is isometric and short, so the geodesic is near it.
TEST(Interpolate, BendsTheCatenoidToTheHelicoidWithoutStretchingIt) {
  const ShapeFamily catenoid = MakeCatenoid(1, 32, 12);
  const auto [path, summary] =
      Interpolate(catenoid.connectivity, {catenoid.pose(0), catenoid.pose(90)}, Options(7, 1e-7));
  EXPECT_EQ(summary.termination, Termination::kConverged);
  EXPECT_LT(summary.quality.edge_rms, 5e-3);
  EXPECT_EQ(summary.quality.folds, 0);
}

TEST(Interpolate, BendsABarEvenly) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2);
  const auto [path, summary] =
      Interpolate(bar.connectivity, {bar.pose(0), bar.pose(90)}, Options(3, 1e-9));
  const Shape half = bar.pose(45) / path.metric->unit;
  const RigidMotion fit = FitRigidMotion(path.shapes[2], half, path.metric->vertex_area);
  EXPECT_LT((fit(path.shapes[2]) - half).colwise().norm().maxCoeff(), 0.01 * Diameter(half));
}

TEST(Interpolate, ScaledEnergyConvergesWithTheSquareOfTheTimeStep) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 8, 2, 2);
  double energy[4];
  for (int i = 0; i < 4; ++i) {
    const auto [path, summary] =
        Interpolate(bar.connectivity, {bar.pose(0), bar.pose(90)}, Options((4 << i) - 1, 1e-11));
    energy[i] = summary.energy;
  }
  EXPECT_LT(energy[0], energy[1]);
  EXPECT_NEAR((energy[1] - energy[0]) / (energy[2] - energy[1]), 4, 0.5);
  EXPECT_NEAR((energy[2] - energy[1]) / (energy[3] - energy[2]), 4, 0.5);
}

TEST(Interpolate, BothSolversFindTheSameMinimum) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 6, 1, 1);
  MetricOptions volume, stiff;
  volume.volume = 0.3;
  stiff.bending = 1e-3;
  MetricOptions rigid = MetricOptions::Rigid();
  rigid.lambda = 1e-2;
  MetricOptions paper = MetricOptions::Paper();
  paper.bending = 1e-4;
  for (const MetricOptions& metric :
       {MetricOptions(), MetricOptions::Isometric(), volume, stiff, rigid, paper}) {
    SCOPED_TRACE(DescribeMetric(metric));
    GeodesicOptions options = Options(4, 1e-13);
    options.metric = metric;
    options.solver = GeodesicSolver::kLbfgs;
    const auto lbfgs = Interpolate(bar.connectivity, {bar.pose(0), bar.pose(70)}, options);
    options.solver = GeodesicSolver::kTrustRegion;
    const auto region = Interpolate(bar.connectivity, {bar.pose(0), bar.pose(70)}, options);
    EXPECT_NEAR(lbfgs.summary.energy, region.summary.energy, 1e-7 * region.summary.energy);
    EXPECT_LT(Distance(lbfgs.path, region.path), 2e-3);
  }
}

TEST(Interpolate, CommutesWithScaling) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 8, 2, 2);
  const auto reference =
      Interpolate(bar.connectivity, {bar.pose(0), bar.pose(80)}, Options(7, 1e-9));
  for (double scale : {1e-4, 1e4}) {
    const auto scaled = Interpolate(bar.connectivity, {scale * bar.pose(0), scale * bar.pose(80)},
                                    Options(7, 1e-9));
    EXPECT_NEAR(scaled.summary.energy, reference.summary.energy, 1e-8 * reference.summary.energy);
    for (int i = 0; i < 9; ++i) {
      EXPECT_LT((scaled.path.Placed(i) / scale - reference.path.Placed(i)).cwiseAbs().maxCoeff(),
                1e-5);
    }
  }
}

TEST(Interpolate, CommutesWithRigidMotionAndRenumbering) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 8, 2, 2);
  const auto reference =
      Interpolate(bar.connectivity, {bar.pose(0), bar.pose(80)}, Options(7, 1e-9));
  const Eigen::Matrix3d turn = Rotation(140, {3, 1, 2});
  const auto move = [&](const Shape& shape) {
    return Shape((turn * shape).colwise() + Eigen::Vector3d(1, 2, 3));
  };
  const auto moved =
      Interpolate(bar.connectivity, {move(bar.pose(0)), move(bar.pose(80))}, Options(7, 1e-9));
  for (int i = 0; i < 9; ++i) {
    EXPECT_LT((moved.path.Placed(i) - move(reference.path.Placed(i))).cwiseAbs().maxCoeff(), 1e-5);
  }

  const int num_vertices = bar.connectivity->NumVertices();
  std::vector<int> number(num_vertices);
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937(3));
  Eigen::Matrix3Xi triangles = bar.connectivity->Triangles();
  for (int& v : triangles.reshaped()) v = number[v];
  const auto shuffle = [&](const Shape& shape) {
    Shape result(3, num_vertices);
    for (int v = 0; v < num_vertices; ++v) result.col(number[v]) = shape.col(v);
    return result;
  };
  const auto renumbered =
      Interpolate(Connectivity::FromTriangles(num_vertices, triangles),
                  {shuffle(bar.pose(0)), shuffle(bar.pose(80))}, Options(7, 1e-9));
  for (int i = 0; i < 9; ++i) {
    EXPECT_LT((renumbered.path.Placed(i) - shuffle(reference.path.Placed(i))).cwiseAbs().maxCoeff(),
              1e-5);
  }
}

TEST(Interpolate, IsTheSameBackwards) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 8, 2, 2);
  const auto there = Interpolate(bar.connectivity, {bar.pose(0), bar.pose(80)}, Options(7, 1e-10));
  const auto back = Interpolate(bar.connectivity, {bar.pose(80), bar.pose(0)}, Options(7, 1e-10));
  EXPECT_NEAR(there.summary.energy, back.summary.energy, 1e-8 * back.summary.energy);
  for (int i = 0; i < 9; ++i) {
    EXPECT_LT((there.path.Placed(i) - back.path.Placed(8 - i)).cwiseAbs().maxCoeff(), 1e-4);
  }
}

TEST(Interpolate, PassesThroughAllPosesAtEvenTimes) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 8, 2, 2);
  const std::vector<Shape> poses = {bar.pose(0), bar.pose(70), bar.pose(20)};
  const auto [path, summary] = Interpolate(bar.connectivity, poses, Options(4, 1e-6));
  ASSERT_EQ(path.NumShapes(), 11);
  EXPECT_EQ(path.poses, (std::vector<int>{0, 5, 10}));
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT((path.Placed(path.poses[k]) - poses[k]).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_NEAR(path.parameters[path.poses[k]], k / 2.0, 1e-15);
  }
  EXPECT_TRUE(std::is_sorted(path.parameters.begin(), path.parameters.end()));
  EXPECT_LT(summary.quality.edge_rms, 0.02);
}

// Compared with a volume that changes evenly from one pose to the other.
TEST(Interpolate, VolumeTermKeepsTheVolumeOnTheWay) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 8, 2, 2);
  const auto volume_of = [&](const Shape& shape) {
    double sum = 0;
    for (const auto& t : bar.connectivity->Triangles().colwise()) {
      sum += shape.col(t(0)).dot(shape.col(t(1)).cross(shape.col(t(2))));
    }
    return sum;
  };
  const auto least_share = [&](double volume) {
    GeodesicOptions options = Options(7, 1e-8);
    options.metric.bending = 0;
    options.metric.volume = volume;
    const Path path = Interpolate(bar.connectivity, {bar.pose(0), bar.pose(150)}, options).path;
    const double first = volume_of(path.shapes.front()), last = volume_of(path.shapes.back());
    double least = 1;
    for (int i = 0; i < path.NumShapes(); ++i) {
      const double t = path.parameters[i];
      least = std::min(least, volume_of(path.shapes[i]) / ((1 - t) * first + t * last));
    }
    return least;
  };
  EXPECT_LT(least_share(0), 0.997);
  EXPECT_GT(least_share(0.3), 0.9995);
}

TEST(Interpolate, ReportsThatItDidNotConverge) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 8, 2, 2);
  GeodesicOptions options = Options(7, 1e-12);
  options.max_iterations = 2;
  const auto [path, summary] = Interpolate(bar.connectivity, {bar.pose(0), bar.pose(90)}, options);
  EXPECT_EQ(summary.termination, Termination::kMaxIterations);
  EXPECT_FALSE(summary.warnings.empty());
  const auto json = nlohmann::json::parse(summary.ToJson());
  EXPECT_EQ(json["converged"], false);
  EXPECT_EQ(json["termination"], "max_iterations");
  EXPECT_EQ(json["levels"].back()["termination"], "max_iterations");
}

// From the second pose to the third the body moves rigidly, for which there is nothing to solve.
TEST(Interpolate, APathConvergesOnlyIfAllItsPiecesDo) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 8, 2, 2);
  GeodesicOptions options = Options(7, 1e-12);
  options.max_iterations = 2;
  std::vector<Shape> poses = {bar.pose(0), bar.pose(90), Rotation(50, {1, 2, 3}) * bar.pose(90)};
  for (const bool reversed : {false, true}) {
    if (reversed) std::reverse(poses.begin(), poses.end());
    const auto [path, summary] = Interpolate(bar.connectivity, poses, options);
    const auto& last = summary.levels.back();
    EXPECT_EQ(last.termination, reversed ? Termination::kMaxIterations : Termination::kConverged);
    EXPECT_EQ(summary.termination, Termination::kMaxIterations);
    EXPECT_FALSE(path.converged);
  }
}

TEST(Interpolate, SummaryAddsUp) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 8, 2, 2);
  const auto [path, summary] =
      Interpolate(bar.connectivity, {bar.pose(0), bar.pose(90)}, Options(6, 1e-6));
  double parts = 0;
  for (const auto& [name, value] : summary.parts) parts += value;
  EXPECT_NEAR(parts, summary.energy, 1e-12);
  EXPECT_NEAR(summary.energy, summary.levels.back().energy, 1e-12);
  EXPECT_EQ(summary.levels.back().shapes, 6);
  EXPECT_GE(summary.Ratio(), 1);
  EXPECT_LT(summary.Ratio(), 1.05);
  EXPECT_LT(summary.levels.back().remaining, 1e-4);
  for (const auto& level : summary.levels)
    EXPECT_LE(level.energy, level.initial_energy * (1 + 1e-12));
  const auto json = nlohmann::json::parse(summary.ToJson());
  EXPECT_EQ(json["levels"].size(), summary.levels.size());
  EXPECT_DOUBLE_EQ(json["energy"].get<double>(), summary.energy);
}

TEST(Interpolate, RefusesWhatCannotWork) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 8, 2, 2);
  EXPECT_THROW(Interpolate(bar.connectivity, {bar.pose(0)}), MeshError);
  EXPECT_TRUE(testing::Refuses<MeshError>(
      [&] {
        Interpolate(bar.connectivity, {bar.pose(0), bar.pose(9).leftCols(7)});
      },
      {"7", std::to_string(bar.connectivity->NumVertices()), "Correspond"}));
  GeodesicOptions options;
  options.shapes = 0;
  EXPECT_THROW(Interpolate(bar.connectivity, {bar.pose(0), bar.pose(9)}, options), InvalidOptions);
  options = {};
  options.memory_limit = 1e4;
  EXPECT_THROW(Interpolate(bar.connectivity, {bar.pose(0), bar.pose(9)}, options), SolverError);
  const ShapeFamily large = MakeBar(6, 1, 1, 60, 20, 20);
  options = {};
  options.metric.volume = 0.3;
  options.solver = GeodesicSolver::kTrustRegion;  // its rows would be dense
  Listener listener;
  EXPECT_THROW(Interpolate(large.connectivity, {large.pose(0), large.pose(9)}, options, &listener),
               InvalidOptions);
  EXPECT_EQ(listener.reports, 1);  // only that of freezing the metric: nothing was solved
}

// A tube with several levels, solved on all of them by all three optimisers.
const ShapeFamily& Tube() {
  static const ShapeFamily tube = MakeBody("tube", 4000);
  return tube;
}

TEST(Interpolate, ReturnsTheBestSoFarWheneverItIsCancelled) {
  const std::vector<Shape> poses = {Tube().pose(0), Tube().pose(90)};
  const auto solve = [&](Progress* progress) {
    return Interpolate(Tube().connectivity, poses, Options(7, 1e-6), progress);
  };
  Listener all;
  int before_solves = 0;
  all.on_report = [&](const std::string& stage, int) {
    before_solves += stage.find(" vertices, ") == std::string::npos;
  };
  const auto [whole, summary] = solve(&all);
  ASSERT_EQ(summary.termination, Termination::kConverged);
  ASSERT_GT(summary.hierarchy.size(), 2u);

  // Before the first solve there is no result to return.
  ASSERT_GT(before_solves, 3);  // also while the mesh is decimated
  for (const int last : {1, 2, before_solves}) {
    Listener early(last);
    EXPECT_THROW(solve(&early), Cancelled);
  }
  std::vector<Shape> blend;
  for (int i = 0; i <= 8; ++i) {
    blend.push_back((1 - i / 8.0) * whole.shapes.front() + i / 8.0 * whole.shapes.back());
  }
  PathEnergy energy(whole.metric, 7);
  std::vector<double> unknowns(energy.Size());
  energy.Load(blend, unknowns.data());
  double before = ScaledEnergy(energy.Evaluate(unknowns.data(), nullptr), 8);
  for (const double share : {0.0, .3, .6, .9, 1.0}) {
    SCOPED_TRACE(share);
    const int first = before_solves + 1;
    Listener stop(first + static_cast<int>(share * (all.reports - first)));
    const auto [path, cancelled] = solve(&stop);
    EXPECT_EQ(cancelled.termination, Termination::kCancelled);
    EXPECT_TRUE(std::any_of(
        cancelled.warnings.begin(), cancelled.warnings.end(),
        [](const std::string& warning) { return warning.rfind("cancelled: ", 0) == 0; }));
    ASSERT_EQ(path.NumShapes(), 9);
    EXPECT_EQ(path.poses, whole.poses);
    EXPECT_EQ(path.parameters, whole.parameters);
    EXPECT_LT((path.Placed(0) - poses[0]).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((path.Placed(8) - poses[1]).cwiseAbs().maxCoeff(), 1e-12);
    // More solves give a better result.
    EXPECT_TRUE(std::isfinite(cancelled.energy));
    EXPECT_LE(cancelled.energy, before * (1 + 1e-6));
    before = cancelled.energy;
  }
  EXPECT_LT(before, 1.01 * summary.energy);
}

TEST(Interpolate, CancelledInOnePieceKeepsTheOnesBefore) {
  const std::vector<Shape> poses = {Tube().pose(0), Tube().pose(60), Tube().pose(20),
                                    Tube().pose(90)};
  const GeodesicOptions options = Options(3, 1e-4);
  Listener all;
  int of_first = 0;
  all.on_report = [&](const std::string&, int) {
    if (all.shares.empty() || all.shares.back() < 1 / 3.0) of_first = all.reports;
  };
  const auto [whole, summary] = Interpolate(Tube().connectivity, poses, options, &all);
  Listener stop(of_first + 5);
  const auto [path, cancelled] = Interpolate(Tube().connectivity, poses, options, &stop);
  EXPECT_EQ(cancelled.termination, Termination::kCancelled);
  ASSERT_EQ(path.NumShapes(), 13);
  EXPECT_EQ(path.poses, whole.poses);
  for (int i = 0; i <= 4; ++i) EXPECT_TRUE(path.shapes[i] == whole.shapes[i]) << i;
  EXPECT_FALSE(path.shapes[6] == whole.shapes[6]);
  // The last piece was not started.
  const Shape middle = 0.5 * (path.shapes[8] + path.shapes[12]);
  EXPECT_LT((path.shapes[10] - middle).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_TRUE(testing::Names(cancelled.warnings.front(), {"2"})) << cancelled.warnings.front();
}

// Work is the cost of evaluations: vertices times shapes. If the share of the work is wrong by a
// quarter in the middle, the estimate of the remaining time is wrong by a factor of two to three.
TEST(Interpolate, TellsWhatShareOfItsWorkIsDone) {
  const SkinnedBody body = MakeSkinnedBody("quadruped", 3000);
  for (const double tolerance : {1e-4, 1e-6}) {
    Listener progress;
    std::vector<double> at_start;  // of each solve
    progress.on_report = [&](const std::string& stage, int iteration) {
      if (iteration == 0 && stage.find(" vertices, ") != std::string::npos) {
        at_start.push_back(progress.shares.back());
      }
    };
    const GeodesicSummary summary =
        Interpolate(body.connectivity, {body.pose("stand"), body.pose("sit"), body.pose("stretch")},
                    Options(15, tolerance), &progress)
            .summary;
    EXPECT_EQ(progress.shares.front(), 0);
    EXPECT_TRUE(std::is_sorted(progress.shares.begin(), progress.shares.end()));
    EXPECT_LE(progress.shares.back(), 1);
    ASSERT_EQ(at_start.size(), summary.levels.size());
    std::vector<double> done = {0};
    for (const auto& level : summary.levels) {
      done.push_back(done.back() +
                     static_cast<double>(level.vertices) * level.shapes * level.evaluations);
    }
    for (size_t i = 0; i < at_start.size(); ++i) {
      EXPECT_NEAR(at_start[i], done[i] / done.back(), 0.25)
          << "solve " << i << " at a tolerance of " << tolerance;
    }
  }
}

// If their distance is at the level of rounding, relative tolerances of it are meaningless; a
// distance above that level is used.
TEST(Interpolate, CopiesConvergeAndPosesThatAreHardlyApartMustBeSolved) {
  std::vector<std::pair<int, int>> segments;
  Shape straight(3, 11);
  for (int i = 0; i <= 10; ++i) {
    straight.col(i) = Eigen::Vector3d(i, 0, 0);
    if (i > 0) segments.emplace_back(i - 1, i);
  }
  const auto stick = Connectivity::Make(11, {0}, {}, segments);
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  for (const auto& [connectivity, shape] :
       {std::make_pair(stick, straight), {bar.connectivity, bar.pose(50)}}) {
    for (const MetricOptions& metric :
         {MetricOptions::Isometric(), MetricOptions::Rigid(), MetricOptions::Paper()}) {
      GeodesicOptions options = Options(5, 1e-15);
      options.metric = metric;
      options.metric.bending = 0;
      options.max_iterations = 1;
      const Shape turned = (Rotation(70, {1, 2, 3}) * shape).colwise() + Eigen::Vector3d(5, 6, 7);
      for (const Shape& copy : {shape, turned}) {
        const auto [path, summary] = Interpolate(connectivity, {shape, copy}, options);
        EXPECT_EQ(summary.termination, Termination::kConverged) << summary.FullReport();
        EXPECT_LT((path.Placed(6) - copy).cwiseAbs().maxCoeff(), 1e-13);
      }
      options.start = GeodesicStart::kFirst;  // not a solution, even under the rigid metric
      Shape other = shape;
      for (int i = 0; i < other.size(); ++i) other.data()[i] += 1e-6 * std::sin(7.0 * i * i);
      const GeodesicSummary apart = Interpolate(connectivity, {shape, other}, options).summary;
      EXPECT_NE(apart.levels.back().solver, "none") << apart.FullReport();
      EXPECT_GT(apart.levels.back().iterations, 0) << apart.FullReport();
    }
  }
}

}  // namespace
}  // namespace shapespace
