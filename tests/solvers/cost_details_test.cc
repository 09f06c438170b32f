// Residuals and derivatives of the blocks for Ceres, on a tiny body of numbers without symmetries:
// residuals against the feature map, derivatives against differences.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <ceres/crs_matrix.h>
#include <ceres/problem.h>
#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/cost/euler_lagrange.h>
#include <shapespace/cost/first_integral.h>
#include <shapespace/cost/internal/refuse_sums.h>
#include <shapespace/cost/path_energy.h>
#include <shapespace/cost/path_energy_function.h>
#include <shapespace/cost/shape_features.h>
#include <shapespace/cost/tangent_projection.h>
#include <shapespace/cost/transport_constraint.h>
#include <shapespace/metric/define_feature.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/path/energy.h>

#include "support/message_of.h"
#include "support/own_features.h"
#include "support/paths.h"

namespace shapespace::cost {
namespace {

using testing::Noise;
using testing::Refuses;

// A tetrahedron, and metrics that are frozen on it.
struct TinyBody {
  std::shared_ptr<const Connectivity> connectivity =
      Connectivity::Make(4, {0, 3, 6, 9, 12}, {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}, {});
  Shape shape = (Shape(3, 4) << 0, 3, 1, 0.5, 0, 0.3, 2, 0.4, 0, -0.2, 0.5, 2.5).finished();

  std::shared_ptr<const Metric> Freeze(MetricOptions options, double volume = 0) const {
    options.volume = volume;
    return FreezeMetric(options, connectivity, {shape});
  }
  // In the metric's unit.
  Shape Near(const Metric& metric, int seed) const {
    return shape / metric.unit + Noise(4, 0.05, seed);
  }
};

Eigen::VectorXd Residuals(ceres::Problem* problem) {
  std::vector<double> residuals;
  EXPECT_TRUE(problem->Evaluate({}, nullptr, &residuals, nullptr, nullptr));
  return Eigen::Map<Eigen::VectorXd>(residuals.data(), static_cast<Eigen::Index>(residuals.size()));
}

// Derivatives with respect to all blocks that are not constant.
void ExpectDerivatives(ceres::Problem* problem) {
  std::vector<double*> blocks;
  problem->GetParameterBlocks(&blocks);
  ceres::Problem::EvaluateOptions variable;
  for (double* block : blocks) {
    if (!problem->IsParameterBlockConstant(block)) variable.parameter_blocks.push_back(block);
  }
  ceres::CRSMatrix sparse;
  std::vector<double> residuals;
  ASSERT_TRUE(problem->Evaluate(variable, nullptr, &residuals, nullptr, &sparse));
  const Eigen::VectorXd alone = Residuals(problem);
  ASSERT_EQ(alone.size(), sparse.num_rows);
  for (int row = 0; row < sparse.num_rows; ++row) EXPECT_NEAR(alone(row), residuals[row], 1e-13);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row) {
    for (int k = sparse.rows[row]; k < sparse.rows[row + 1]; ++k) {
      jacobian(row, sparse.cols[k]) = sparse.values[k];
    }
  }
  int column = 0;
  for (double* block : variable.parameter_blocks) {
    for (int k = 0; k < problem->ParameterBlockSize(block); ++k, ++column) {
      constexpr double kStep = 1e-5;
      const double at = block[k];
      block[k] = at + kStep;
      const Eigen::VectorXd after = Residuals(problem);
      block[k] = at - kStep;
      const Eigen::VectorXd before = Residuals(problem);
      block[k] = at;
      const Eigen::VectorXd difference = (after - before) / (2 * kStep);
      EXPECT_LT((jacobian.col(column) - difference).norm(), 1e-6 * (1 + jacobian.norm())) << column;
    }
  }
  EXPECT_EQ(column, sparse.num_cols);
}

void SetConstantFrom(const std::vector<double*>& blocks, ceres::Problem* problem) {
  for (double* block : blocks) problem->SetParameterBlockConstant(block);
}

TEST(CostDetails, RowsOfTheEulerLagrangeEquationAreScaledAndDifferentiated) {
  const TinyBody body;
  for (double volume : {0., 0.3}) {
    const auto metric = body.Freeze({}, volume);
    const FeatureMap map(metric);
    const Shape at = body.Near(*metric, 1);
    Shape shape = body.Near(*metric, 2);
    const Eigen::VectorXd target = 2 * map.Values(at) - map.Values(body.Near(*metric, 3));
    const EulerLagrange equation(*metric, at, target, 1.75);
    EXPECT_EQ(equation.NumSums(), volume > 0 ? 1 : 0);
    std::vector<double> sums = {7, 8, 9};
    ceres::Problem problem;
    equation.AddTo(&shape, &sums, &problem);
    ASSERT_EQ(static_cast<int>(sums.size()), equation.NumSums());
    const Eigen::VectorXd residuals = Residuals(&problem);
    ASSERT_EQ(residuals.size(), 12 + equation.NumSums());
    const Tangent expected = 1.75 * map.Derivative(at).TransposeTimes(map.Values(shape) - target);
    EXPECT_LT((residuals.head(12).reshaped(3, 4) - expected).norm(), 1e-12 * expected.norm());
    ExpectDerivatives(&problem);
    // The rounding of each row is of the order of its terms, which are greater than their sum.
    EXPECT_GT(equation.Rounding(), 1e-16 * expected.norm());
    EXPECT_NEAR(EulerLagrange(*metric, at, target, 3.5).Rounding(), 2 * equation.Rounding(),
                1e-12 * equation.Rounding());
    if (volume == 0) continue;
    EXPECT_NEAR(residuals(12), 0, 1e-12);  // the sum is that of the shape
    EXPECT_NEAR(sums[0], map.Values(shape).tail(1)(0), 1e-12);
    // An error of the sum counts as much as in the other rows.
    sums[0] += 0.01;
    const Eigen::VectorXd off = Residuals(&problem) - residuals;
    EXPECT_NEAR(std::abs(off(12)), off.head(12).norm(), 1e-12);
    sums[0] -= 0.01;
    SetConstantFrom({shape.col(1).data(), &sums[0]}, &problem);
    ExpectDerivatives(&problem);
  }
}

TEST(CostDetails, RowsOfTheFirstIntegralAreTheEquations) {
  const TinyBody body;
  const auto metric = body.Freeze({});
  const FeatureMap map(metric);
  const Shape at = body.Near(*metric, 1);
  const Eigen::SparseMatrix<double> matrix =
      map.Derivative(at).MetricMatrix().selfadjointView<Eigen::Lower>();
  const Tangent constants = Noise(4, 1, 4);
  Tangent velocity = Noise(4, 1, 5);
  const Tangent product = (matrix * velocity.reshaped()).reshaped(3, 4);
  const Tangent expected = 0.75 * (2 * constants - 2 * velocity.cwiseProduct(product));
  ceres::Problem problem;
  AddFirstIntegral(matrix, constants, 0.75, &velocity, &problem);
  EXPECT_LT((Residuals(&problem).reshaped(3, 4) - expected).norm(), 1e-12 * expected.norm());
  ExpectDerivatives(&problem);
}

TEST(CostDetails, TransportKeepsTheVectorAndTheConstraintByItsWeight) {
  const Tangent normal = Noise(4, 1, 6), start = Noise(4, 1, 7), way = Noise(4, 0.1, 8);
  Tangent y = start;
  double bound = 0.6;
  ceres::Problem problem;
  AddTransportConstraint(normal, 2.5, &bound, &y, &problem);
  EXPECT_TRUE(problem.IsParameterBlockConstant(&bound));
  y += way;
  const Eigen::VectorXd residuals = Residuals(&problem);
  ASSERT_EQ(residuals.size(), 13);
  EXPECT_LT((residuals.head(12) - way.reshaped()).norm(), 1e-14);
  EXPECT_NEAR(residuals(12), 2.5 * (y.cwiseProduct(normal).sum() - 0.6), 1e-13);
  problem.SetParameterBlockVariable(&bound);
  SetConstantFrom({y.col(2).data()}, &problem);
  ExpectDerivatives(&problem);
}

TEST(CostDetails, TangentsAreProjectedByTheDerivative) {
  const TinyBody body;
  const auto metric = body.Freeze({});
  const FeatureMap map(metric);
  const Shape at = body.Near(*metric, 1);
  Tangent y = Noise(4, 1, 9);
  const Eigen::VectorXd change = map.Derivative(at).Times(Noise(4, 1, 10));
  ceres::Problem problem;
  AddTangentProjection(*metric, at, change, &y, &problem);
  const Eigen::VectorXd expected = map.Derivative(at).Times(y) - change;
  EXPECT_LT((Residuals(&problem) - expected).norm(), 1e-12 * expected.norm());
  SetConstantFrom({y.col(0).data()}, &problem);
  ExpectDerivatives(&problem);
}

TEST(CostDetails, SegmentsHaveTheDerivativesOfTheirDifferences) {
  const TinyBody body;
  for (const MetricOptions& options : {MetricOptions(), MetricOptions::Paper()}) {
    const auto metric = body.Freeze(options, 0.3);
    std::vector<Shape> shapes = {body.Near(*metric, 1), body.Near(*metric, 2),
                                 body.Near(*metric, 3)};
    ceres::Problem problem;
    AddPathEnergy(*metric, &shapes, &problem, nullptr, 0.5);
    ExpectDerivatives(&problem);
    SetConstant(&shapes[0], &problem);
    SetConstantFrom({shapes[1].col(2).data()}, &problem);
    ExpectDerivatives(&problem);
  }
}

// Features with derivatives of their own that are wrong, and not even finite.
template <typename Struct, typename Own>
struct WronglyDerived : testing::CopyOf<Struct, Own> {
  static constexpr bool kHasDerivatives = true;

  void Derivatives(const double* x, double* value, double* derivative) const {
    (*this)(x, value);
    std::fill_n(derivative, 3 * Struct::kVertices * Struct::kValues, NAN);
  }
};
struct WrongStrain : WronglyDerived<TriangleStrain, WrongStrain> {
  static constexpr const char* kName = "wrongly derived strain";
};
struct WrongDihedral : WronglyDerived<Dihedral, WrongDihedral> {
  static constexpr const char* kName = "wrongly derived dihedral";
};
struct WrongVolume : WronglyDerived<VolumeFeature, WrongVolume> {
  static constexpr const char* kName = "wrongly derived volume";
};

// Every block of every cost function evaluates the functor of a term alone, by Jets.
TEST(CostDetails, DerivativesAreThoseOfTheFunctorWhateverAFeatureSaysThatTheyAre) {
  RegisterFeature<WrongStrain>();
  RegisterFeature<WrongDihedral>();
  RegisterFeature<WrongVolume>();
  const TinyBody body;
  MetricOptions options;
  options.features = {{"wrongly derived strain", 0.7}, {"wrongly derived dihedral", 0.2}};
  const auto without_sum = body.Freeze(options);
  options.features.push_back({"wrongly derived volume", 0.3});
  const auto metric = body.Freeze(options);
  ASSERT_FALSE(
      FeatureMap(metric).Derivative(body.Near(*metric, 1)).Times(Noise(4, 1, 2)).allFinite());

  std::vector<Shape> shapes = {body.Near(*metric, 1), body.Near(*metric, 2), body.Near(*metric, 3)};
  ceres::Problem segments;
  AddPathEnergy(*metric, &shapes, &segments);
  ExpectDerivatives(&segments);

  ShapeFeatures features(metric, &shapes);
  ceres::Problem::Options shared;
  shared.evaluation_callback = &features;
  ceres::Problem at_once(shared);
  AddPathEnergy(*metric, &shapes, &at_once, nullptr, 1, &features);
  ExpectDerivatives(&at_once);

  const FeatureMap map(metric);
  const Shape at = shapes[1];
  const EulerLagrange equation(*metric, at, 2 * map.Values(at) - map.Values(shapes[0]));
  EXPECT_TRUE(std::isfinite(equation.Rounding()));
  std::vector<double> sums;
  ceres::Problem rows;
  equation.AddTo(&shapes[2], &sums, &rows);
  EXPECT_TRUE(Residuals(&rows).allFinite());
  ExpectDerivatives(&rows);

  Tangent y = Noise(4, 1, 9);
  const Eigen::VectorXd change = FeatureMap(without_sum).Values(shapes[1]) * 0.1;
  ceres::Problem projection;
  AddTangentProjection(*without_sum, at, change, &y, &projection);
  EXPECT_TRUE(Residuals(&projection).allFinite());
  ExpectDerivatives(&projection);
}

TEST(CostDetails, TheFunctionOfAPathIsItsEnergyAsAShare) {
  const TinyBody body;
  const auto metric = body.Freeze({});
  std::vector<Shape> shapes;
  for (int i = 0; i < 5; ++i) shapes.push_back(body.Near(*metric, i));
  const PathEnergyFunction function(metric, shapes);
  ASSERT_EQ(function.NumParameters(), 3 * 4 * 3);
  PathEnergy energy(metric, 3);
  std::vector<double> unknowns(energy.Size());
  const auto energy_of = [&](const std::vector<Shape>& path) {
    energy.Load(path, unknowns.data());
    return energy.Evaluate(unknowns.data(), nullptr);
  };
  const double before = energy_of(shapes);
  EXPECT_NEAR(function.InitialEnergy(), 4 * before / 2, 1e-12 * before);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(36), gradient(36);
  double cost;
  ASSERT_TRUE(function.Evaluate(y.data(), &cost, nullptr));
  EXPECT_NEAR(cost, 1, 1e-14);
  for (int k = 0; k < 36; ++k) y(k) = 0.01 * std::sin(1.3 * k);
  ASSERT_TRUE(function.Evaluate(y.data(), &cost, gradient.data()));
  EXPECT_NEAR(cost, energy_of(function.PathAt(y.data())) / before, 1e-12);
  for (int k = 0; k < 36; ++k) {
    double after, earlier;
    const double at = y(k);
    y(k) = at + 1e-5;
    function.Evaluate(y.data(), &after, nullptr);
    y(k) = at - 1e-5;
    function.Evaluate(y.data(), &earlier, nullptr);
    y(k) = at;
    EXPECT_NEAR(gradient(k), (after - earlier) / 2e-5, 1e-6 * (1 + gradient.norm())) << k;
  }
  EXPECT_TRUE(Refuses<MeshError>(
      [&] {
        PathEnergyFunction(metric, {shapes[0], shapes[1]});
      },
      {"three shapes"}));
  EXPECT_TRUE(Refuses<SolverError>(
      [&] {
        PathEnergyFunction(metric, {shapes[0], shapes[1].array() / 0, shapes[2]});
      },
      {"energy"}));
}

TEST(CostDetails, RefusalsNameWhatIsWrong) {
  const TinyBody body;
  const auto metric = body.Freeze({}), with_volume = body.Freeze({}, 0.3),
             rigid = body.Freeze(MetricOptions::Rigid());
  const Shape at = body.Near(*metric, 1);
  Tangent y = Noise(4, 1, 2);
  ceres::Problem problem;
  const auto projecting = [&](const Metric& of, int size) {
    return [&, size] { AddTangentProjection(of, at, Eigen::VectorXd::Zero(size), &y, &problem); };
  };
  const int size = static_cast<int>(FeatureMap(metric).Values(at).size());
  EXPECT_TRUE(Refuses<MeshError>(projecting(*metric, 3), {"3", std::to_string(size)}));
  EXPECT_TRUE(Refuses<InvalidOptions>(projecting(*with_volume, size), {"volume:", "0"}));
  EXPECT_TRUE(Refuses<InvalidOptions>(projecting(*rigid, size), {"rigid:", "0"}));
  const auto adding = [&](const Metric& of, std::vector<Shape> shapes) {
    return [&, shapes]() mutable { AddPathEnergy(of, &shapes, &problem); };
  };
  EXPECT_TRUE(Refuses<MeshError>(adding(*metric, {at}), {"two shapes"}));
  EXPECT_TRUE(Refuses<MeshError>(adding(*metric, {at, at, at.leftCols(3)}), {"vertices"}));
  EXPECT_TRUE(Refuses<InvalidOptions>(adding(*rigid, {at, at}), {"motions:"}));
  EXPECT_EQ(problem.NumParameterBlocks(), 0);
  EXPECT_NO_THROW(RefuseSums(*with_volume, 4, "do not"));
  EXPECT_NO_THROW(RefuseSums(*metric, 3, "do not"));
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { RefuseSums(*with_volume, 3, "do not"); },
                                      {"volume:", "do not"}));
}

}  // namespace
}  // namespace shapespace::cost
