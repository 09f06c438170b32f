// The small parts that solvers share, against closed forms: rotations and stretches of triangles,
// shapes from their sides, limits of memory and options, and what reports are made of.

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <ceres/iteration_callback.h>
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/task_group.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/correspondence/detail/memory.h>
#include <shapespace/deformation/detail/memory.h>
#include <shapespace/exponential/internal/memory.h>
#include <shapespace/geodesic/internal/memory.h>
#include <shapespace/mesh/internal/triangle_deformation.h>
#include <shapespace/minimise/internal/keep_going.h>
#include <shapespace/minimise/internal/minimise.h>
#include <shapespace/sparse/internal/gradient_integrator.h>
#include <shapespace/sparse/internal/padded_width.h>
#include <shapespace/sparse/internal/solve.h>
#include <shapespace/spline/detail/memory.h>
#include <shapespace/statistics/detail/memory.h>
#include <shapespace/summary/internal/check_options.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/memory.h>
#include <shapespace/summary/internal/report.h>
#include <shapespace/transfer/detail/memory.h>

#include "support/listener.h"
#include "support/message_of.h"

namespace shapespace::internal {
namespace {

using testing::MessageOf;
using testing::Names;
using testing::Refuses;

// A function of a symmetric matrix, by its eigenvalues.
Eigen::Matrix2d Of(const SymmetricMatrix2& s, double (*function)(double)) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(s.Matrix());
  Eigen::Vector2d values = eigen.eigenvalues();
  for (double& value : values) value = function(value);
  return eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
}

TEST(TriangleDeformation, LogarithmAndExponentialAreThoseOfEigenvalues) {
  for (const SymmetricMatrix2& s :
       {SymmetricMatrix2{2, 0.5, 1}, {0.3, -0.2, 4}, {1.5, 0, 1.5}, {3, 0, 0.5}}) {
    EXPECT_LT((Log(s).Matrix() - Of(s, std::log)).norm(), 1e-13);
    EXPECT_LT((Exp(s).Matrix() - Of(s, std::exp)).norm(), 1e-12);
    const Eigen::Vector3d vector = s.Vector();
    EXPECT_NEAR(vector.norm(), s.Matrix().norm(), 1e-14);
    EXPECT_EQ(vector(0), s.xx);
    EXPECT_EQ(vector(2), s.yy);
    EXPECT_LT((SymmetricMatrix2::FromVector(vector).Matrix() - s.Matrix()).norm(), 1e-15);
    EXPECT_EQ(std::signbit(vector(1)), std::signbit(s.xy));
  }
}

TEST(TriangleDeformation, RotationVectorsAreAnglesTimesAxes) {
  const Eigen::Vector3d axis = Eigen::Vector3d(2, -1, 2) / 3;
  for (double angle : {0.001, 0.7, 3., -2.}) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, axis));
    EXPECT_LT((Log(turn) - angle * axis).norm(), 1e-12);
    EXPECT_LT((Log(Eigen::Quaterniond(-turn.coeffs())) - angle * axis).norm(), 1e-12);
    EXPECT_LT(Exp(Eigen::Vector3d(angle * axis)).angularDistance(turn), 1e-7);
  }
  // The shorter way.
  EXPECT_LT((Log(Eigen::Quaterniond(Eigen::AngleAxisd(4, axis))) - (4 - 2 * M_PI) * axis).norm(),
            1e-12);
  EXPECT_EQ(Log(Eigen::Quaterniond::Identity()).norm(), 0);
  EXPECT_EQ(Exp(Eigen::Vector3d(0, 0, 0)).coeffs(), Eigen::Quaterniond::Identity().coeffs());
}

TEST(TriangleDeformation, FrameBeginsAtTheFirstCornerAlongTheFirstSide) {
  const Eigen::Vector3d p(1, 2, 3), q(1, 2, 5), r(1, 6, 4);
  const TriangleFrame frame(p, q, r);
  EXPECT_LT((frame.edges - (Eigen::Matrix2d() << 2, 1, 0, 4).finished()).norm(), 1e-14);
  Eigen::Matrix3d axes;
  axes << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  EXPECT_LT((frame.axes - axes).norm(), 1e-14);
}

// A triangle is stretched in its own plane and turned: both are found again.
TEST(TriangleDeformation, IsTheTurnAndTheStretchThatWereMade) {
  Eigen::Matrix3d corners;
  corners << 0, 2, 0.5, 0, 0, 1.5, 0, 0, 0;
  const auto frame_of = [](const Eigen::Matrix3d& x) {
    return TriangleFrame(x.col(0), x.col(1), x.col(2));
  };
  const Eigen::Matrix2d inverse = frame_of(corners).edges.inverse();
  const SymmetricMatrix2 stretch = {1.4, 0.3, 0.6};
  Eigen::Matrix3d stretches = Eigen::Matrix3d::Identity();
  stretches.topLeftCorner<2, 2>() = stretch.Matrix();
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(2.2, Eigen::Vector3d(1, 3, -2).normalized()));
  const Eigen::Matrix3d moved =
      (turn.toRotationMatrix() * stretches * corners).colwise() + Eigen::Vector3d(5, -6, 7);
  const TriangleDeformation pose(frame_of(moved), inverse);
  EXPECT_LT((pose.rotation.toRotationMatrix() - turn.toRotationMatrix()).norm(), 1e-13);
  EXPECT_LT((pose.stretch.Matrix() - stretch.Matrix()).norm(), 1e-13);
}

// Sides that fit together are met, each component where its places have their mean.
TEST(GradientIntegrator, FindsTheShapeOfItsSides) {
  Shape shape(3, 5);
  shape << 0, 3, 1, 7, 9, 0, 1, 4, -2, 5, 2, 0, 1, 3, 8;
  const std::vector<GradientIntegrator::Side> sides = {
      {0, 1, 1}, {2, 1, 0.5}, {0, 2, 3}, {4, 3, 2}};
  const GradientIntegrator integrator(5, sides);
  ASSERT_EQ(integrator.Sides().size(), 4u);
  Eigen::Matrix3Xd wanted(3, 4);
  for (int i = 0; i < 4; ++i) wanted.col(i) = shape.col(sides[i].to) - shape.col(sides[i].from);
  Shape places = shape;
  const Eigen::Vector3d first(10, 20, -30), second(-7, 0, 50);
  places.leftCols(3).colwise() += first;
  places.rightCols(2).colwise() += second;
  places.col(0).array() += 6;  // a mean of 2 for three vertices
  const Shape found = integrator.Integrate(wanted, places);
  Shape expected = shape;
  expected.leftCols(3).colwise() += first + Eigen::Vector3d(2, 2, 2);
  expected.rightCols(2).colwise() += second;
  EXPECT_LT((found - expected).norm(), 1e-3);
}

// Two sides between the same vertices that want different things: the mean by weight.
TEST(GradientIntegrator, WeighsSidesThatDisagree) {
  const GradientIntegrator integrator(2, {{0, 1, 1}, {1, 0, 3}});
  Eigen::Matrix3Xd wanted(3, 2);
  wanted << 4, -8, 0, 4, 1, 1;
  const Shape found = integrator.Integrate(wanted, Shape::Zero(3, 2));
  const Eigen::Vector3d expected(7, -3, -0.5);
  EXPECT_LT((found.col(1) - found.col(0) - expected).norm(), 1e-3);
  EXPECT_LT((found.col(1) + found.col(0)).norm(), 1e-9);
}

// Two triangles; an edge from a corner to a vertex without triangles, one between two such, and a
// stiffener between the triangles.
TEST(SurfaceIntegrator, PlacesWhatIsInNoTriangle) {
  const auto connectivity =
      Connectivity::Make(9, {0, 3, 6}, {0, 1, 2, 3, 4, 5}, {{6, 2}, {7, 8}, {1, 3}});
  Shape base = Shape::Random(3, 9);
  const SurfaceIntegrator integrator(*connectivity, Eigen::Matrix3Xd::Ones(3, 2));
  const auto sides = [&](int f) -> Eigen::Matrix3d {
    return TriangleSides(base, connectivity->Triangles().col(f));
  };
  Shape places = base;
  places.middleCols(3, 3).colwise() += Eigen::Vector3d(5, 0, 0);  // a triangle away from its place
  places.col(6) += Eigen::Vector3d(0, 3, 0);
  places.col(8) += Eigen::Vector3d(0, 0, 2);
  const Shape found = integrator.Integrate(
      base, places, sides, [](int) { return Eigen::Matrix3d(2 * Eigen::Matrix3d::Identity()); });
  const auto side = [](const Shape& shape, int a, int b) -> Eigen::Vector3d {
    return shape.col(b) - shape.col(a);
  };
  EXPECT_LT((side(found, 3, 4) - side(base, 3, 4)).norm(), 1e-2);
  EXPECT_LT((side(found, 2, 6) - side(places, 2, 6)).norm(), 1e-2);
  EXPECT_LT((side(found, 7, 8) - side(places, 7, 8)).norm(), 1e-2);
  EXPECT_LT((side(found, 1, 3) - 2 * side(base, 1, 3)).norm(), 1e-1);
}

TEST(Solve, TakesAnyNumberOfColumns) {
  Eigen::SparseMatrix<double> matrix(3, 3);
  matrix.insert(0, 0) = 4;
  matrix.insert(2, 0) = 1;
  matrix.insert(1, 1) = 2;
  matrix.insert(2, 2) = 3;
  matrix.makeCompressed();
  const Cholesky factor(matrix);
  for (int columns : {1, 4, 5, 9}) {
    Eigen::MatrixXd x(3, columns);
    for (int k = 0; k < columns; ++k) x.col(k) << 1 + k, -2 * k, 5 - k;
    const Eigen::MatrixXd right = matrix.selfadjointView<Eigen::Lower>() * x;
    EXPECT_LT((Solve(factor, right) - x).norm(), 1e-12) << columns;
  }
  EXPECT_EQ(PaddedWidth<double>(1), 4);
  EXPECT_EQ(PaddedWidth<double>(4), 4);
  EXPECT_EQ(PaddedWidth<double>(5), 8);
  EXPECT_EQ(PaddedWidth<float>(8), 8);
  EXPECT_EQ(PaddedWidth<float>(9), 16);
}

TEST(Cholesky, SaysWhatAnIndefiniteMatrixMayComeFrom) {
  Eigen::SparseMatrix<double> matrix(2, 2);
  matrix.insert(0, 0) = 1;
  matrix.insert(1, 1) = -1;
  matrix.makeCompressed();
  EXPECT_TRUE(Refuses<SolverError>([&] { const Cholesky factor(matrix); }, {"weight"}));
}

TEST(CheckOptions, RefusesWhatIsOutOfRange) {
  const auto tolerance = [](double value) {
    return MessageOf<InvalidOptions>([&] { CheckTolerance(value); });
  };
  for (double value : {0., -1e-9, 1., 2., std::nan("")}) {
    EXPECT_TRUE(Names(tolerance(value), {"tolerance:", "0", "1"})) << value;
  }
  EXPECT_EQ(tolerance(1e-300), "nothing was thrown");
  EXPECT_EQ(tolerance(0.999), "nothing was thrown");
  const auto iterations = [](int value) {
    return MessageOf<InvalidOptions>([&] { CheckMaxIterations(value); });
  };
  EXPECT_TRUE(Names(iterations(0), {"max_iterations:", "1"}));
  EXPECT_EQ(iterations(1), "nothing was thrown");
}

TEST(Memory, RefusalsSayHowManyMegabytesAreNeeded) {
  EXPECT_TRUE(Refuses<SolverError>([] { CheckMemory("this call", 2.6e6, 2.5e6, "do less"); },
                                   {"this call", "3 MB", "do less", "memory_limit"}));
  EXPECT_NO_THROW(CheckMemory("", 2.5e6, 2.5e6, ""));
  for (double limit : {0., -1., std::nan("")}) {
    EXPECT_TRUE(Refuses<InvalidOptions>([&] { CheckMemoryLimit(limit); }, {"memory_limit:"}));
  }
  EXPECT_NO_THROW(CheckMemoryLimit(1e-3));
}

// What each further pose, shape, tangent or marker adds to an estimate: the arrays of each.
TEST(Memory, EstimatesRiseByWhatIsAdded) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 6, 1, 1);
  const std::vector<Shape> poses = {bar.pose(0), bar.pose(40)};
  const auto metric = FreezeMetric({}, bar.connectivity, poses);
  const double vertices = bar.connectivity->NumVertices(), shape = 24 * vertices;
  double values = 0;
  for (const auto& feature : metric->features) values += feature->NumValues();
  // Every pose, and the shapes before it, twice.
  EXPECT_NEAR(GeodesicBytes(*metric, 5, 7) - GeodesicBytes(*metric, 4, 7), 2 * 8 * shape, 1e-6);
  EXPECT_NEAR(TransportBytes(*metric, 9) - TransportBytes(*metric, 4), 2 * 5 * shape, 1e-6);
  EXPECT_NEAR(AverageBytes(*metric, 9) - AverageBytes(*metric, 6), 3 * (2 * 8 * values + 2 * shape),
              1e-6);
  EXPECT_NEAR(FeatureTransferBytes(*metric, 9) - FeatureTransferBytes(*metric, 6), 12 * shape,
              1e-6);
  EXPECT_NEAR(LadderBytes(*metric, 9, 3) - LadderBytes(*metric, 6, 3), 12 * shape, 1e-6);
  EXPECT_NEAR(LadderBytes(*metric, 6, 5) - LadderBytes(*metric, 6, 3),
              GeodesicBytes(*metric, 2, 5) - GeodesicBytes(*metric, 2, 3), 1e-6);
  const double quantities = 2. * bar.connectivity->NumTriangles() + vertices;
  EXPECT_NEAR(SplineBytes(*bar.connectivity, 5, 7) - SplineBytes(*bar.connectivity, 4, 7),
              24 * 6 * quantities + 2 * 8 * shape, 1e-6);
  const auto other = Connectivity::Make(3, {0, 3}, {0, 1, 2}, {});
  EXPECT_NEAR(CorrespondenceBytes(*bar.connectivity, *other, 9) -
                  CorrespondenceBytes(*bar.connectivity, *other, 4),
              5 * 8 * (vertices + 3), 1e-6);
  EXPECT_GT(CorrespondenceBytes(*bar.connectivity, *other, 0),
            CorrespondenceBytes(*other, *bar.connectivity, 0));
  // A preconditioner has 300 numbers per vertex with bending, and 45 without; a second geodesic
  // shares the first one's unless it is of the trapezoid.
  MetricOptions flat;
  flat.bending = 0;
  const auto unbent = FreezeMetric(flat, bar.connectivity, poses);
  for (const auto& [of, numbers] : {std::make_pair(metric, 300), {unbent, 45}}) {
    EXPECT_NEAR(GeodesicBytes(*of, 2, 7) - FurtherGeodesicBytes(*of, 7), 8 * numbers * vertices,
                1e-6);
  }
  const auto paper = FreezeMetric(MetricOptions::Paper(), bar.connectivity, poses);
  EXPECT_EQ(GeodesicBytes(*paper, 2, 7), FurtherGeodesicBytes(*paper, 7));
  // A deformation has eight vectors more than a geodesic, and another factor, but no paths.
  EXPECT_NEAR(DeformationBytes(*metric, 7) - GeodesicBytes(*metric, 2, 7),
              8 * 7 * shape + 8 * 300 * vertices - 2 * 9 * shape, 1e-6);
  EXPECT_EQ(HistoryRank(3e5), 20);
  EXPECT_EQ(HistoryRank(3e5 + 1), 5);
}

TEST(Report, WhatJsonDoesNotHaveIsNullOrReplaced) {
  EXPECT_EQ(JsonOf(std::vector<double>{0.5, std::nan(""), HUGE_VAL}).dump(), "[0.5,null,null]");
  const std::vector<std::pair<std::string, double>> parts = {{"strain", 2}, {"bending", 1}};
  EXPECT_EQ(TextOf(JsonOf(parts)), "{\n  \"strain\": 2.0,\n  \"bending\": 1.0\n}\n");
  EXPECT_EQ(TextOf(JsonOf(std::string("a\xff"))), "\"a\xEF\xBF\xBD\"\n");
  EXPECT_EQ(Format("%s", std::string(600, 'x').c_str()).size(), 511u);
}

TEST(KeepGoing, AsksAfterEveryIterationWithItsEnergy) {
  std::vector<std::pair<int, double>> asked;
  const std::function<bool(int, double)> ask = [&](int iteration, double energy) {
    asked.emplace_back(iteration, energy);
    return iteration < 2;
  };
  KeepGoing keep_going(ask);
  ceres::IterationSummary summary;
  for (int i : {1, 2}) {
    summary.iteration = i;
    summary.cost = 0.5 * i;
    EXPECT_EQ(keep_going(summary),
              i < 2 ? ceres::SOLVER_CONTINUE : ceres::SOLVER_TERMINATE_SUCCESSFULLY);
    EXPECT_EQ(keep_going.Stopped(), i == 2);
  }
  EXPECT_EQ(asked, (std::vector<std::pair<int, double>>{{1, 0.5}, {2, 1}}));
  const std::function<bool(int, double)> none;
  KeepGoing always(none);
  EXPECT_EQ(always(summary), ceres::SOLVER_CONTINUE);
  EXPECT_FALSE(always.Stopped());
}

// A number tells that all smaller ones have begun, here or elsewhere.
TEST(TaskGroup, CountsTasksOfOtherProcessesByTheNumberOfItsOwn) {
  testing::Listener listener;
  std::vector<int> done;
  listener.on_report = [&](const std::string&, int ended) { done.push_back(ended); };
  TaskGroup group(&listener, "all", 8);
  for (int i : {2, 5, 3}) group.Run(i, [](Progress*) {});
  EXPECT_EQ(done, (std::vector<int>{2, 5, 6}));
  EXPECT_EQ(listener.shares, (std::vector<double>{0, 3. / 8, 6. / 8, 6. / 8}));
}

TEST(TaskGroup, ThrowsWhatRunsAllOfThemUnlessATaskHasFailed) {
  TaskGroup group(nullptr, "", 3);
  EXPECT_TRUE(Refuses<MeshError>([&] { group.Guard([] { throw MeshError("of the caller"); }); },
                                 {"of the caller"}));
  EXPECT_TRUE(Refuses<SolverError>(
      [&] {
        group.Guard([&] {
          try {
            group.Run(0, [](Progress*) { throw SolverError("of a task"); });
          } catch (const SolverError&) {
          }
          EXPECT_THROW(group.Run(1, [](Progress*) { FAIL() << "begins"; }), Cancelled);
          throw MeshError("of the caller");
        });
      },
      {"of a task"}));
}

}  // namespace
}  // namespace shapespace::internal
