#include <shapespace/transfer/transfer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/skinned.h>
#include <shapespace/transfer/detail/feature_transfer.h>

#include "support/listener.h"
#include "support/message_of.h"
#include "support/path_of.h"
#include "support/transfer_cases.h"

namespace shapespace {
namespace {

using namespace testing;

TransferOptions WithHybrids(TransferMethod method = TransferMethod::kFeatures) {
  TransferOptions options;
  options.method = method;
  options.hybrids = true;
  return options;
}

// Properties of both methods.
class AnyTransfer : public ::testing::TestWithParam<TransferMethod> {};

INSTANTIATE_TEST_SUITE_P(Methods, AnyTransfer,
                         ::testing::Values(TransferMethod::kFeatures, TransferMethod::kLadder),
                         [](const auto& info) {
                           return info.param == TransferMethod::kLadder ? "Ladder" : "Features";
                         });

TEST_P(AnyTransfer, SaysThatTheTargetIsAMirrorImage) {
  const Path source = Bending(2);
  TransferOptions options;
  options.method = GetParam();
  const size_t before = Transfer(source, ThinBar(), options).summary.warnings.size();
  Shape mirrored = ThinBar();
  mirrored.row(1) *= -1;
  const TransferSummary summary = Transfer(source, mirrored, options).summary;
  ASSERT_GT(summary.warnings.size(), before);
  EXPECT_NE(summary.warnings.front().find("mirror"), std::string::npos);
}

// Compared with an independent implementation of their method.
TEST(GradientTransfer, IsThatOfSumnerAndPopovic) {
  const SkinnedBody normal = MakeSkinnedBody("quadruped", 1500),
                    heavy = MakeSkinnedBody("quadruped", 1500, "heavy");
  const struct {
    std::shared_ptr<const Connectivity> connectivity;
    Shape source, deformed, target;
  } cases[] = {
      {ThickBar().connectivity, ThickBar().pose(0), ThickBar().pose(60), ThinBar()},
      {normal.connectivity, normal.pose("stand"), normal.pose("sit"), heavy.pose("stand")}};
  for (const auto& [connectivity, source, deformed, target] : cases) {
    const Shape theirs = SumnerPopovic::Transfer(*connectivity, source, deformed, target);
    const Shape ours = internal::GradientTransfer(connectivity, source, target)(deformed);
    const Vector3d offset = (theirs - ours).rowwise().mean();  // theirs fixes one vertex
    EXPECT_LT(Apart(ours.colwise() + offset, theirs), 1e-5);
    EXPECT_GT(Apart(ours.colwise() + offset, target), 0.1);
  }
}

// Motions that a mesh does not determine are taken from the source: one bar moves up, another one
// rotates.
TEST(GradientTransfer, ComponentsAndVerticesWithoutTrianglesGoWhereTheSourcesGo) {
  const Connectivity& bar = *ThickBar().connectivity;
  const int m = bar.NumVertices();
  Eigen::Matrix3Xi triangles(3, 2 * bar.NumTriangles());
  triangles << bar.Triangles(), bar.Triangles().array() + m;
  std::vector<int> begin, corners(triangles.data(), triangles.data() + triangles.size());
  for (int i = 0; i <= triangles.cols(); ++i) begin.push_back(3 * i);
  // A stick is attached to the first bar, and a vertex to nothing.
  const auto connectivity = Connectivity::Make(2 * m + 2, begin, corners, {{0, 2 * m}});
  const auto both = [&](const Shape& one, const Shape& other, const Vector3d& lonely) {
    Shape result(3, 2 * m + 2);
    result << one, other.colwise() + Vector3d(0, 0, 20), one.col(0) + Vector3d(0, 0, 1), lonely;
    return result;
  };
  const Shape thick = ThickBar().pose(0), thin = ThinBar();
  const Vector3d up(0, 3, 0);
  const Matrix3d turn = Rotation(90, Vector3d::UnitX());
  const internal::GradientTransfer transfer(connectivity, both(thick, thick, {9, 9, 9}),
                                            both(thin, thin, {8, 8, 8}));
  const Shape result = transfer(both(thick.colwise() + up, turn * thick, {9, 9, 5}));
  const Shape expected = both(thin.colwise() + up, turn * thin, {8, 8, 4});
  const Shape off = result - expected;
  // The second bar rotates about the centre of its source's, which is not its own.
  const Vector3d shift = off.middleCols(m, m).rowwise().mean();
  EXPECT_LT(shift.norm(), 1.5);
  EXPECT_LT((off.middleCols(m, m).colwise() - shift).norm(), 1e-4);
  EXPECT_LT(off.leftCols(m).norm(), 1e-4);
  EXPECT_LT(off.rightCols(2).norm(), 1e-4);
}

TEST(FindNearestShape, FindsAShapeByItsFeatures) {
  const auto metric =
      FreezeMetric(MetricOptions::Strain(), ThickBar().connectivity, {ThickBar().pose(0)});
  const FeatureMap map(metric);
  const Shape start = ThickBar().pose(0) / metric->unit, bent = ThickBar().pose(20) / metric->unit;
  const Eigen::VectorXd wanted = map.Values(bent);
  internal::MetricSolver solver;
  int asked = 0;
  const auto find = [&](double tolerance, int max_iterations) {
    return internal::FindNearestShape(
        map, wanted, start, {tolerance, max_iterations}, [&] { ++asked; }, &solver);
  };
  const internal::NearestShape found = find(1e-20, 30);
  EXPECT_TRUE(found.Converged());
  EXPECT_LT(Apart(found.shape, bent), 1e-9);
  EXPECT_NEAR(found.squared_distance, (map.Values(found.shape) - wanted).squaredNorm(), 1e-22);
  EXPECT_EQ(asked, found.iterations);
  const internal::NearestShape early = find(1e-20, 1);
  EXPECT_FALSE(early.Converged());
  EXPECT_EQ(early.iterations, 1);
  EXPECT_LT(early.squared_distance, (map.Values(start) - wanted).squaredNorm());
}

// Full Gauss-Newton steps would overshoot here.
TEST(FindNearestShape, ShortensStepsThatLeadTooFar) {
  const auto metric =
      FreezeMetric(MetricOptions::Strain(), ThickBar().connectivity, {ThickBar().pose(0)});
  const FeatureMap map(metric);
  const Shape start = ThickBar().pose(0) / metric->unit, bent = ThickBar().pose(150) / metric->unit;
  internal::MetricSolver solver;
  const internal::NearestShape found = internal::FindNearestShape(
      map, map.Values(bent), start, {1e-20, 100}, [] {}, &solver);
  EXPECT_TRUE(found.Converged());
  EXPECT_LT(Apart(found.shape, bent), 1e-6);
}

// What a turn gains is far below the rounding of the steps, since position costs next to nothing.
TEST(FindNearestShape, TurnsABodyWhosePositionCostsNextToNothing) {
  MetricOptions options = MetricOptions::Strain();
  options.lambda = 1e-10;
  const auto metric = FreezeMetric(options, ThickBar().connectivity, {ThickBar().pose(0)});
  const FeatureMap map(metric);
  const Shape bent = ThickBar().pose(20) / metric->unit;
  internal::MetricSolver solver;
  const internal::NearestShape found = internal::FindNearestShape(
      map, map.Values(bent), Rotation(50, Vector3d(1, 2, 2).normalized()) * bent, {1e-20, 100},
      [] {}, &solver);
  EXPECT_TRUE(found.Converged());
  EXPECT_LT(Apart(found.shape, bent), 1e-4);
}

// A triangle of the target has collapsed to a point.
TEST(GradientTransfer, CollapsedTrianglesMakeNoNan) {
  const Connectivity& bar = *ThickBar().connectivity;
  Shape target = ThinBar();
  for (int k : {1, 2}) target.col(bar.Triangles()(k, 0)) = target.col(bar.Triangles()(0, 0));
  const internal::GradientTransfer transfer(ThickBar().connectivity, ThickBar().pose(0), target);
  EXPECT_TRUE(transfer(ThickBar().pose(60)).allFinite());
}

// The result does not depend on the target's position and size.
TEST_P(AnyTransfer, BendsAnotherBarAsSumnerAndPopovicDo) {
  const bool ladder = GetParam() == TransferMethod::kLadder;
  const Path source = Bending(6);
  const Shape straight = ThinBar();
  const Shape theirs = SumnerPopovic::Transfer(*source.metric->connectivity, source.Placed(0),
                                               source.Placed(6), straight);
  EXPECT_NEAR(BendOf(straight, theirs), 62.1, 0.1);  // as measured with another implementation
  const struct {
    Matrix3d turn;
    double scale;
  } places[] = {{Matrix3d::Identity(), 1},
                {Rotation(90, Vector3d::UnitZ()), 1},
                {Rotation(90, Vector3d::UnitY()), 1},
                {Rotation(130, {1, 2, 3}), 3},
                {Matrix3d::Identity(), 0.2}};
  TransferOptions options;
  options.method = GetParam();
  for (const auto& [turn, scale] : places) {
    const auto [path, hybrids, summary] =
        Transfer(source, (scale * turn * straight).colwise() + Vector3d(20, -3, 1), options);
    EXPECT_TRUE(summary.Converged());
    ASSERT_EQ(path.NumShapes(), 7);
    const Shape end = turn.transpose() * path.Placed(6) / scale;
    EXPECT_NEAR(BendOf(straight, end), ladder ? 60 : 62.4, ladder ? 3.5 : 0.4);
    EXPECT_NEAR(StrainOf(*source.metric, straight, end), ladder ? 0.022 : 0.023,
                ladder ? 1e-3 : 2e-3);
    EXPECT_LT(ShapesApart(end, theirs, source.metric->vertex_area), ladder ? 0.005 : 0.002);
  }
}

// Closer to the source's strains and angles than Sumner and Popovic's, and equally close to the
// body's own pose.
TEST(Transfer, BodiesWithJointsTakeThePoseOver) {
  const SkinnedBody normal = MakeSkinnedBody("quadruped", 3000);
  double ours = 0, theirs = 0;
  for (const char* proportions : {"long", "short", "heavy"}) {
    const SkinnedBody other = MakeSkinnedBody("quadruped", 3000, proportions);
    const Shape stand = other.pose("stand");
    const std::vector<Shape> poses = {normal.pose("stand"), normal.pose("stride"),
                                      normal.pose("rear"), normal.pose("sit")};
    const auto [path, hybrids, summary] = TransferPoses(normal.connectivity, poses, stand);
    EXPECT_TRUE(summary.Converged());
    const Eigen::VectorXd &area = path.metric->vertex_area, &hinge_area = path.metric->hinge_area;
    int i = 0;
    for (const char* pose : {"stride", "rear", "sit"}) {
      SCOPED_TRACE(std::string(proportions) + ", " + pose);
      const Shape own = other.pose(pose), made = path.Placed(++i);
      const Shape sumner_popovic =
          SumnerPopovic::Transfer(*normal.connectivity, poses[0], poses[i], stand);
      EXPECT_LT(ShapesApart(made, own, area), 0.007);
      EXPECT_GT(ShapesApart(stand, own, area), 0.02);
      EXPECT_LT(Degrees(FitRigidMotion(made, own, area).rotation), 2);
      ours += ShapesApart(made, own, area) / 9;
      theirs += ShapesApart(sumner_popovic, own, area) / 9;
      const auto angles_off = [&](const Shape& shape) {
        const auto change = [&](const Shape& from, const Shape& to) -> Eigen::VectorXd {
          return DihedralAngles(*normal.connectivity, to) -
                 DihedralAngles(*normal.connectivity, from);
        };
        const Eigen::VectorXd off = change(stand, shape) - change(poses[0], poses[i]);
        return off.unaryExpr(&WrapAngle).cwiseAbs2().dot(hinge_area);
      };
      EXPECT_LT(angles_off(made), 0.6 * angles_off(sumner_popovic));
    }
  }
  EXPECT_LT(ours, 0.0045);
  EXPECT_LT(ours, 1.1 * theirs);
}

TEST(Transfer, ACopyMovesAsTheSourceDoes) {
  std::vector<Shape> shapes;
  for (int i = 0; i <= 3; ++i) {
    // The path has a rigid motion and an oblique start.
    shapes.push_back((Rotation(40 + 30 * i, {1, 1, 0}) * ThickBar().pose(20 * i)).colwise() +
                     Vector3d(i, 7, -2 * i));
  }
  const Path source = PathOf(ThickBar().connectivity, shapes);
  const Matrix3d turn = Rotation(100, {3, -1, 2});
  const double scale = 2.5;
  const auto copy = [&](const Shape& shape) -> Shape {
    return (scale * turn * shape).colwise() + Vector3d(-11, 4, 0.5);
  };
  const auto [path, hybrids, summary] = Transfer(source, copy(shapes[0]), WithHybrids());
  EXPECT_TRUE(summary.Converged());
  EXPECT_NEAR(summary.scale, scale, 1e-12);
  EXPECT_LT(summary.strain_max, 1e-9);
  EXPECT_LT(summary.angle_rms, 1e-7);
  for (int i = 0; i <= 3; ++i) {
    EXPECT_LT(Apart(path.Placed(i), copy(shapes[i])), 1e-10) << i;
    EXPECT_LT(Apart(hybrids.Placed(i), copy(shapes[i])), 1e-10) << i;
  }
}

// Pairs of triangles without area, and a pose in which more of them collapse.
TEST(Transfer, CollapsedTrianglesAreNoObstacle) {
  Shape straight = ThickBar().pose(0), bent = ThickBar().pose(40), thin = ThinBar();
  for (Shape* shape : {&straight, &bent, &thin}) shape->col(7) = shape->col(8);
  bent.col(40) = bent.col(41);
  const Path source = PathOf(ThickBar().connectivity, {straight, bent});
  const auto copy = [&](const Shape& shape) -> Shape {
    return 3 * Rotation(50, {1, 2, 3}) * shape;
  };
  const Path of_copy = Transfer(source, copy(straight)).path;
  EXPECT_LT(Apart(of_copy.Placed(1), copy(bent)), 1e-8);
  const auto [path, hybrids, summary] = Transfer(source, thin);
  EXPECT_TRUE(summary.Converged());
  EXPECT_TRUE(path.Placed(1).allFinite());
  EXPECT_NEAR(BendOf(thin, path.Placed(1)), 41, 2);
}

// The source's hinge turns from 170 to 190 degrees, of which the latter is also -170; the target's
// stays below 180.
TEST(Transfer, AnglesThatPassHalfATurnAreNotOff) {
  const auto hinge = Connectivity::Make(4, {0, 3, 6}, {0, 1, 2, 1, 0, 3});
  const auto folded = [](double degrees) {
    Shape shape(3, 4);
    shape << 0, 0, 1, 0, -0.5, 0.5, 0, 0, 0, 0, 0, 0;
    shape.col(3) = Rotation(180 - degrees, -Vector3d::UnitY()) * Vector3d::UnitX();
    return shape;
  };
  const auto angle = [&](const Shape& shape) {
    return DihedralAngles(*hinge, shape)(0) * 180 / M_PI;
  };
  std::vector<Shape> shapes;
  for (const double degrees : {170, 175, 185, 190}) shapes.push_back(folded(degrees));
  ASSERT_NEAR(angle(shapes.front()), 170, 1e-9);
  ASSERT_NEAR(angle(shapes.back()), -170, 1e-9);
  const auto [path, hybrids, summary] = Transfer(PathOf(hinge, shapes), folded(150));
  EXPECT_NEAR(angle(path.Placed(3)), 170, 0.01);
  EXPECT_LT(summary.angle_rms, 0.01);
}

TEST(Transfer, ASourceThatRestsLeavesTheTargetAsItIs) {
  const Shape rest = ThickBar().pose(0);
  const Path source = PathOf(ThickBar().connectivity, {rest, rest, rest});
  const auto [path, hybrids, summary] = Transfer(source, ThinBar());
  EXPECT_TRUE(summary.Converged());
  EXPECT_LT(Apart(path.Placed(2), ThinBar()), 1e-9);
}

TEST_P(AnyTransfer, HybridsStandHalfWay) {
  const auto [path, hybrids, summary] = Transfer(Bending(3), ThinBar(), WithHybrids(GetParam()));
  ASSERT_EQ(hybrids.NumShapes(), 4);
  const auto proportion = [](const Shape& shape) {
    const Vector3d extent = shape.rowwise().maxCoeff() - shape.rowwise().minCoeff();
    return std::log(extent(0) / extent(2));
  };
  // Strains are logarithmic, so the midpoint of two boxes is the geometric mean.
  EXPECT_NEAR(proportion(hybrids.Placed(0)),
              (proportion(ThickBar().pose(0)) + proportion(ThinBar())) / 2, 0.02);
}

TEST(Transfer, SaysWhatItsPathsAre) {
  Path source = Bending(3);
  source.provenance = "a test";
  const auto [path, hybrids, summary] = Transfer(source, ThinBar(), WithHybrids());
  EXPECT_TRUE(path.Placed(0).isApprox(ThinBar(), 1e-14));
  EXPECT_EQ(path.parameters, source.parameters);
  EXPECT_EQ(path.poses, std::vector<int>{0});
  EXPECT_EQ(path.extrapolated, 3);
  EXPECT_EQ(path.provenance, "a test; transferred");
  EXPECT_EQ(hybrids.parameters, source.parameters);
  EXPECT_TRUE(hybrids.poses.empty());
  EXPECT_EQ(hybrids.provenance, "a test; hybrids");
  for (const Path& made : {path, hybrids}) {
    for (const Shape& shape : made.shapes) {
      EXPECT_LT(Centroid(shape, made.metric->vertex_area).norm(), 1e-12);
    }
  }
  EXPECT_EQ(summary.steps.size(), 3u);
  EXPECT_EQ(summary.metric, "strain 1, lambda 1000, bending 0.0001");
  EXPECT_GT(summary.strain_rms, 0.01);  // less strain on the thin bar
  EXPECT_LT(summary.strain_rms, 0.05);
  EXPECT_LT(summary.angle_rms, 3);
  EXPECT_TRUE(summary.warnings.empty());
  const auto json = nlohmann::json::parse(summary.ToJson());
  EXPECT_EQ(json["converged"], true);
  EXPECT_EQ(json["method"], "features");
  EXPECT_EQ(json["steps"].size(), 3u);
  EXPECT_EQ(json["scale"], summary.scale);
  EXPECT_EQ(json["strain_rms"], summary.strain_rms);
  EXPECT_EQ(json["angle_rms"], summary.angle_rms);

  EXPECT_EQ(DescribeMetric(path.metric->options), DescribeMetric(MetricOptions::Strain()));
  EXPECT_TRUE(Transfer(source, ThinBar()).hybrids.shapes.empty());
}

// A source and a target in other frames and sizes make the same motion, in the target's frame.
TEST_P(AnyTransfer, CommutesWithRotationAndScale) {
  const Shape straight = ThinBar();
  const TransferOptions options = WithHybrids(GetParam());
  const Path reference = Transfer(Bending(3), straight, options).path;
  const Matrix3d turn = Rotation(75, {1, 2, -1});
  for (double scale : {1e-4, 1.0, 1e4}) {
    std::vector<Shape> shapes;
    for (int i = 0; i <= 3; ++i) shapes.push_back(scale * turn * ThickBar().pose(20 * i));
    const Path moved = PathOf(ThickBar().connectivity, shapes);
    const Path of_source = Transfer(moved, straight, options).path;
    const Path of_target = Transfer(Bending(3), scale * turn * straight, options).path;
    for (int i = 0; i <= 3; ++i) {
      EXPECT_LT(Apart(of_source.Placed(i), reference.Placed(i)), 1e-6) << scale;
      EXPECT_LT(Apart(of_target.Placed(i), scale * turn * reference.Placed(i)), 1e-6) << scale;
    }
  }
}

TEST_P(AnyTransfer, DoesNotDependOnTheNumbersOfVertices) {
  const Path source = Bending(3);
  const Connectivity& connectivity = *source.metric->connectivity;
  std::vector<int> number(connectivity.NumVertices());
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937(5));
  const auto renumbered = [&](const Shape& shape) {
    Shape result = shape;
    for (int v = 0; v < shape.cols(); ++v) result.col(number[v]) = shape.col(v);
    return result;
  };
  Eigen::Matrix3Xi triangles = connectivity.Triangles();
  for (int& v : triangles.reshaped()) v = number[v];
  const auto other = Connectivity::FromTriangles(connectivity.NumVertices(), triangles);
  std::vector<Shape> shapes;
  for (const Shape& shape : source.Placed()) shapes.push_back(renumbered(shape));
  TransferOptions options = WithHybrids(GetParam());
  options.ladder.tolerance = 1e-12;
  const Path a = Transfer(source, ThinBar(), options).path;
  const Path b = Transfer(PathOf(other, shapes), renumbered(ThinBar()), options).path;
  EXPECT_LT(Apart(b.Placed(3), renumbered(a.Placed(3))), 1e-5);
}

TEST(TransferPoses, EveryPoseIsReachedOnItsOwn) {
  const auto& connectivity = ThickBar().connectivity;
  const std::vector<Shape> poses = {ThickBar().pose(0), ThickBar().pose(60), ThickBar().pose(30)};
  const auto [path, hybrids, summary] =
      TransferPoses(connectivity, poses, ThinBar(), {}, WithHybrids());
  ASSERT_EQ(path.NumShapes(), 3);
  ASSERT_EQ(hybrids.NumShapes(), 3);
  EXPECT_EQ(path.parameters, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(path.poses, std::vector<int>{0});
  EXPECT_EQ(path.extrapolated, 2);
  EXPECT_TRUE(path.Placed(0).isApprox(ThinBar(), 1e-14));
  EXPECT_NEAR(BendOf(ThinBar(), path.Placed(1)), 60, 4);
  EXPECT_NEAR(BendOf(ThinBar(), path.Placed(2)), 30, 2);
  // Weights are frozen on all poses, which are the only data shared by the transfers.
  const auto alone = TransferPoses(connectivity, {poses[0], poses[2]}, ThinBar());
  EXPECT_LT(Apart(alone.path.Placed(1), path.Placed(2)), 1e-3);

  ASSERT_EQ(summary.transfers.size(), 1u);
  EXPECT_EQ(summary.transfers[0].steps.size(), 2u);
  EXPECT_TRUE(summary.geodesics.empty());
  EXPECT_TRUE(summary.Converged());
  EXPECT_TRUE(summary.Warnings().empty());
  EXPECT_EQ(summary.BriefReport(), summary.transfers[0].BriefReport());
  EXPECT_EQ(summary.FullReport(), summary.transfers[0].FullReport());
  EXPECT_EQ(summary.ToJson(), summary.transfers[0].ToJson());

  EXPECT_THROW(TransferPoses(connectivity, {poses[0]}, ThinBar()), MeshError);
}

TEST(Transfer, RefusesWhatCannotBeTransferred) {
  const Path source = Bending(2);
  const auto refusal = [&](const Shape& target) {
    return MessageOf<MeshError>([&] { Transfer(source, target); });
  };
  EXPECT_TRUE(Names(refusal(ThinBar().leftCols(7)), {"7", "106", "Correspond"}));
  Shape broken = ThinBar();
  broken(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(broken).find("not finite"), std::string::npos);
  EXPECT_NE(refusal(Shape::Zero(3, 106)).find("no extent"), std::string::npos);
  EXPECT_THROW(Transfer(FirstShapes(source, 1), ThinBar()), MeshError);
  const auto message = [&](void (*change)(TransferOptions*)) {
    TransferOptions options;
    change(&options);
    return MessageOf<InvalidOptions>([&] { Transfer(source, ThinBar(), options); });
  };
  EXPECT_EQ(message([](TransferOptions* o) { o->metric.rigid = 1; }).find("metric.rigid:"), 0u);
  EXPECT_EQ(message([](TransferOptions* o) {
              o->metric.discretization = Discretization::kTrapezoid;
            }).find("metric.discretization:"),
            0u);
  EXPECT_EQ(message([](TransferOptions* o) { o->metric.bending = -1; }).find("bending:"), 0u);
  EXPECT_EQ(message([](TransferOptions* o) { o->tolerance = 0; }).find("tolerance:"), 0u);
  EXPECT_EQ(message([](TransferOptions* o) { o->max_iterations = 0; }).find("max_iterations:"), 0u);
}

TEST(Transfer, SaysSoWhereASolveRunsOut) {
  TransferOptions options;
  options.tolerance = 1e-14;
  options.max_iterations = 1;
  const auto [path, hybrids, summary] = Transfer(Bending(2), ThinBar(), options);
  EXPECT_FALSE(summary.Converged());
  EXPECT_FALSE(path.converged);
  ASSERT_EQ(summary.warnings.size(), 1u);
  EXPECT_TRUE(Names(summary.warnings[0], {"2 of 2"}));
}

TEST_P(AnyTransfer, KeepsTheShapesMadeBeforeItIsCancelled) {
  Listener all;
  int reports_before_the_third = 0;
  all.on_report = [&](const std::string& stage, int done) {
    EXPECT_EQ(stage, "transferring");
    reports_before_the_third += done < 2;
  };
  const TransferResult whole = Transfer(Bending(3), ThinBar(), WithHybrids(GetParam()), &all);
  EXPECT_EQ(all.shares, (std::vector<double>{0, .25, .5, .75}));
  EXPECT_TRUE(whole.summary.Converged());

  for (const int last : {1, 2, 6}) {
    Listener early(last);
    EXPECT_THROW(Transfer(Bending(3), ThinBar(), WithHybrids(GetParam()), &early), Cancelled)
        << last;
  }
  for (const int last : {1, 9}) {  // before the third rung, and within it
    Listener later(reports_before_the_third + last);
    const auto [path, hybrids, summary] =
        Transfer(Bending(3), ThinBar(), WithHybrids(GetParam()), &later);
    EXPECT_TRUE(summary.cancelled);
    EXPECT_FALSE(summary.Converged());
    ASSERT_FALSE(summary.warnings.empty());
    EXPECT_NE(summary.warnings[0].find("cancelled"), std::string::npos);
    EXPECT_EQ(summary.steps.size(), 1u);
    ASSERT_EQ(path.NumShapes(), 2);
    ASSERT_EQ(hybrids.NumShapes(), 2);
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(path.parameters[i], whole.path.parameters[i]);
      EXPECT_LT(Apart(path.Placed(i), whole.path.Placed(i)), 1e-12);
      EXPECT_LT(Apart(hybrids.Placed(i), whole.hybrids.Placed(i)), 1e-12);
    }
    // Differences are relative to the source's second shape, not its last.
    EXPECT_LT(summary.strain_rms, whole.summary.strain_rms);
  }
}

TEST_P(AnyTransfer, AnExactCopyConvergesAndMakesTheVeryMotion) {
  // An additional straight stick, which is determined only by its first bending.
  std::vector<std::pair<int, int>> segments;
  Shape straight(3, 11), arc(3, 11);
  for (int i = 0; i <= 10; ++i) {
    straight.col(i) = Vector3d(i, 0, 0);
    arc.col(i) = Vector3d(5 * std::sin(.2 * i), 5 - 5 * std::cos(.2 * i), 0);
    if (i > 0) segments.emplace_back(i - 1, i);
  }
  const auto stick = Connectivity::Make(11, {0}, {}, segments);
  const SkinnedBody quadruped = MakeSkinnedBody("quadruped", 3000);
  const struct {
    std::shared_ptr<const Connectivity> connectivity;
    Shape first, second;
  } bodies[] = {{stick, straight, arc},
                {quadruped.connectivity, quadruped.pose("stand"), quadruped.pose("sit")}};
  for (const auto& [connectivity, first, second] : bodies) {
    for (const double scale : {1.0, 3.0}) {
      const auto copy = [&, scale = scale](const Shape& shape) -> Shape {
        return (scale * Rotation(70, {1, 2, 3}) * shape).colwise() + Vector3d(5, 6, 7);
      };
      GeodesicOptions geodesic;
      geodesic.shapes = 3;
      const auto [path, hybrids, summary] = TransferPoses(
          connectivity, {first, second}, copy(first), geodesic, WithHybrids(GetParam()));
      EXPECT_TRUE(summary.Converged()) << summary.BriefReport();
      // The rotation of a straight stick about its own axis is arbitrary.
      const Eigen::VectorXd area = Eigen::VectorXd::Ones(first.cols());
      EXPECT_LT(ShapesApart(path.Placed(1), copy(second), area), 1e-11);
      EXPECT_LT(ShapesApart(hybrids.Placed(1), copy(second), area), 1e-11);
    }
  }
}

}  // namespace
}  // namespace shapespace
