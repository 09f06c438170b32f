#include <shapespace/metric/feature_map.h>

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <Eigen/SparseCore>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/path/energy.h>

#include "support/features.h"
#include "support/message_of.h"
#include "support/paths.h"
#include "support/stiffened.h"

namespace shapespace {
namespace {

using testing::Noise;

struct Case {
  std::string name;
  std::shared_ptr<const Connectivity> connectivity;
  std::shared_ptr<const Metric> metric;
  Shape shape;  // in the metric's unit, with some noise, so that nothing is symmetric
};

Case Bent(const std::string& name, const ShapeFamily& body, const MetricOptions& options) {
  const auto metric = FreezeMetric(options, body.connectivity, {body.pose(0), body.pose(60)});
  const Shape pose = body.pose(30) / metric->unit;
  return {name, body.connectivity, metric, pose + Noise(static_cast<int>(pose.cols()), 0.01, 1)};
}

// All features, on a closed bar with additional edges inside.
Case AllFeatures() {
  MetricOptions options;
  options.isometric = 1;
  options.strain = 0.2;
  options.volume = 0.3;
  return Bent("all features", testing::Stiffened(MakeBar(6, 1, 1, 6, 2, 2)), options);
}

std::vector<Case> Cases() {
  MetricOptions paper = MetricOptions::Paper();
  paper.discretization = Discretization::kMidpoint;
  return {AllFeatures(), Bent("default, open sheet", MakeSheet(2, 1, 8, 5), {}),
          Bent("paper, open sheet", MakeSheet(2, 1, 8, 5), paper)};
}

// The part of `values` (of Phi, of a derivative) that belongs to each feature, by the feature's
// name.
std::vector<std::pair<std::string, Eigen::VectorXd>> ByFeature(const Metric& metric,
                                                               const Eigen::VectorXd& values) {
  std::vector<std::pair<std::string, Eigen::VectorXd>> parts;
  int begin = 0;
  for (const auto& feature : metric.features) {
    const int size = feature->NumValues();
    parts.emplace_back(feature->Name(), values.segment(begin, size));
    begin += size;
  }
  EXPECT_EQ(begin, values.size());
  return parts;
}

// Expects that every part of `got` equals that of `expected`, to `tolerance` of the latter's norm.
void ExpectNearByFeature(const Metric& metric, const Eigen::VectorXd& got,
                         const Eigen::VectorXd& expected, double tolerance) {
  const auto got_parts = ByFeature(metric, got), expected_parts = ByFeature(metric, expected);
  for (size_t i = 0; i < got_parts.size(); ++i) {
    SCOPED_TRACE(got_parts[i].first);
    const double norm = expected_parts[i].second.norm();
    EXPECT_GT(norm, 0);
    EXPECT_LE((got_parts[i].second - expected_parts[i].second).norm(), tolerance * norm);
  }
}

TEST(FeatureMap, ValuesAreThoseOfTheGeometryTimesTheRootOfTheWeight) {
  const Case test = AllFeatures();
  const Connectivity& mesh = *test.connectivity;
  const auto parts = ByFeature(*test.metric, FeatureMap(test.metric).Values(test.shape));
  ASSERT_EQ(parts.size(), 6u);
  for (const auto& [name, values] : parts) {
    SCOPED_TRACE(name);
    const auto length = [&](int e) {
      const Eigen::Vector2i edge = mesh.Edges().col(e);
      return (test.shape.col(edge(1)) - test.shape.col(edge(0))).norm();
    };
    if (name == "edge length") {
      const auto& feature = testing::Get<EdgeLength>(*test.metric);
      for (int e = 0; e < mesh.NumEdges(); ++e) {
        const double expected = std::sqrt(feature.weights(e)) * length(e) * length(e) / 2;
        EXPECT_NEAR(values(e), expected, 1e-13);
      }
    } else if (name == "log length") {  // of edges that are no sides of triangles
      ASSERT_EQ(mesh.NumTriangleEdges() + values.size(), mesh.NumEdges());
      for (int i = 0; i < values.size(); ++i) {
        const int e = mesh.NumTriangleEdges() + i;
        EXPECT_NEAR(values(i), std::sqrt(0.2 * test.metric->edge_area(e)) * std::log(length(e)),
                    1e-13);
      }
    } else if (name == "triangle strain") {
      const Eigen::Matrix2d equilateral{{1, 0.5}, {0, std::sqrt(0.75)}};
      for (int f = 0; f < mesh.NumTriangles(); ++f) {
        const Eigen::Vector3i t = mesh.Triangles().col(f);
        Eigen::Matrix<double, 3, 2> edges;
        edges << test.shape.col(t(1)) - test.shape.col(t(0)),
            test.shape.col(t(2)) - test.shape.col(t(0));
        const Eigen::Vector4d r = testing::Get<TriangleStrain>(*test.metric).numbers.col(f);
        const Eigen::Matrix2d from_rest{{r(0), r(2)}, {r(1), r(3)}};
        const Eigen::Vector2d stretches =
            Eigen::JacobiSVD<Eigen::MatrixXd>(edges * from_rest * equilateral.inverse())
                .singularValues();
        const double a = std::log(stretches(0)), b = std::log(stretches(1));
        const double root = std::sqrt(testing::Get<TriangleStrain>(*test.metric).weights(f));
        EXPECT_NEAR(values(3 * f), root * (a + b) / 2, 1e-13);
        EXPECT_NEAR(values.segment<2>(3 * f + 1).norm(), root * (a - b) / std::sqrt(8.0), 1e-13);
      }
    } else if (name == "position") {
      for (int v = 0; v < mesh.NumVertices(); ++v) {
        const Eigen::Vector3d expected =
            std::sqrt(1e-4 * test.metric->vertex_area(v)) * test.shape.col(v);
        EXPECT_LT((values.segment<3>(3 * v) - expected).norm(), 1e-15);
      }
    } else if (name == "dihedral") {
      const auto& feature = testing::Get<Dihedral>(*test.metric);
      for (int h = 0; h < mesh.NumHinges(); ++h) {
        const Eigen::Vector4i v = mesh.Hinges().col(h);
        const Eigen::Vector3d a = test.shape.col(v(0)), b = test.shape.col(v(1));
        const Eigen::Vector3d m = (b - a).cross(test.shape.col(v(2)) - a).normalized();
        const Eigen::Vector3d n = (test.shape.col(v(3)) - a).cross(b - a).normalized();
        const double root = std::sqrt(feature.weights(h));
        EXPECT_NEAR(values(2 * h), root * m.dot(n), 1e-13);
        EXPECT_NEAR(values(2 * h + 1), root * m.cross(n).dot((b - a).normalized()), 1e-13);
      }
    } else {
      double volume = 0, reference = 0;
      const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
      for (int f = 0; f < mesh.NumTriangles(); ++f) {
        const Eigen::Vector3i t = mesh.Triangles().col(f);
        const auto of = [&](const Shape& p) {
          return p.col(t(0)).cross(p.col(t(1))).dot(p.col(t(2))) / 6;
        };
        volume += of(test.shape);
        reference += 0.5 * (of(bar.pose(0)) + of(bar.pose(60))) / std::pow(test.metric->unit, 3);
      }
      EXPECT_NEAR(values(0), std::sqrt(0.3) * volume / reference, 1e-13);
    }
  }
}

TEST(FeatureMap, DerivativeIsThatOfCentralDifferences) {
  for (const Case& test : Cases()) {
    SCOPED_TRACE(test.name);
    const FeatureMap map(test.metric);
    const Tangent x = Noise(static_cast<int>(test.shape.cols()), 1, 2);
    const double h = 1e-5;  // third derivatives leave 1e-10 / |e|^2, rounding 1e-16 / 1e-5
    const Eigen::VectorXd differences =
        (map.Values(test.shape + h * x) - map.Values(test.shape - h * x)) / (2 * h);
    ExpectNearByFeature(*test.metric, map.Derivative(test.shape).Times(x), differences, 1e-6);
  }
}

TEST(FeatureMap, SecondDerivativeIsThatOfDifferencesOfTheFirst) {
  for (const Case& test : Cases()) {
    SCOPED_TRACE(test.name);
    const FeatureMap map(test.metric);
    const Tangent x = Noise(static_cast<int>(test.shape.cols()), 1, 3);
    const double h = 1e-5;
    const Eigen::VectorXd differences = (map.Derivative(test.shape + h * x).Times(x) -
                                         map.Derivative(test.shape - h * x).Times(x)) /
                                        (2 * h);
    const auto got = ByFeature(*test.metric, map.SecondDerivative(test.shape, x));
    const auto expected = ByFeature(*test.metric, differences);
    for (size_t i = 0; i < got.size(); ++i) {
      SCOPED_TRACE(got[i].first);
      // Positions are linear: their differences are rounding errors divided by h.
      const double rounding = 1e-14 / h;
      EXPECT_LE((got[i].second - expected[i].second).norm(),
                1e-6 * expected[i].second.norm() + rounding);
      EXPECT_EQ(got[i].second.norm() == 0, got[i].first == "position");
    }
  }
}

TEST(FeatureMap, TransposeTimesIsTheAdjointOfTimes) {
  for (const Case& test : Cases()) {
    SCOPED_TRACE(test.name);
    const FeatureDerivative derivative = FeatureMap(test.metric).Derivative(test.shape);
    const Tangent x = Noise(static_cast<int>(test.shape.cols()), 1, 4);
    const Eigen::VectorXd jx = derivative.Times(x);
    const Eigen::VectorXd y = Eigen::VectorXd::Random(jx.size());
    const Tangent jty = derivative.TransposeTimes(y);
    EXPECT_NEAR(jx.dot(y), x.cwiseProduct(jty).sum(), 1e-13 * jx.norm() * y.norm());
    // One feature at a time, because features differ in size.
    int begin = 0;
    for (const auto& [name, part] : ByFeature(*test.metric, jx)) {
      SCOPED_TRACE(name);
      Eigen::VectorXd only = Eigen::VectorXd::Zero(jx.size());
      only.segment(begin, part.size()) = y.segment(begin, part.size());
      begin += static_cast<int>(part.size());
      EXPECT_NEAR(jx.dot(only), x.cwiseProduct(derivative.TransposeTimes(only)).sum(),
                  1e-12 * part.norm() * only.norm());
    }
  }
}

TEST(FeatureMap, SegmentsHaveTheEnergyOfAPath) {
  for (const Case& test : Cases()) {
    SCOPED_TRACE(test.name);
    const FeatureMap map(test.metric);
    const int num_vertices = static_cast<int>(test.shape.cols());
    const std::vector<Shape> shapes = {test.shape, test.shape + Noise(num_vertices, 0.02, 5),
                                       test.shape + Noise(num_vertices, 0.03, 6)};
    PathEnergy energy(test.metric, 1);
    std::vector<double> unknowns(energy.Size());
    energy.Load(shapes, unknowns.data());
    const double expected = energy.Evaluate(unknowns.data(), nullptr);
    const double segments = 2 * (map.Values(shapes[1]) - map.Values(shapes[0])).squaredNorm() +
                            2 * (map.Values(shapes[2]) - map.Values(shapes[1])).squaredNorm();
    EXPECT_NEAR(segments, expected, 1e-12 * expected);
  }
}

TEST(FeatureDerivative, MetricMatrixIsTheProductButForSums) {
  for (const Case& test : Cases()) {
    SCOPED_TRACE(test.name);
    const FeatureDerivative derivative = FeatureMap(test.metric).Derivative(test.shape);
    const Eigen::SparseMatrix<double> matrix = derivative.MetricMatrix();
    ASSERT_EQ(matrix.rows(), test.shape.size());
    EXPECT_EQ(Eigen::SparseMatrix<double>(matrix.triangularView<Eigen::StrictlyUpper>()).norm(), 0);
    const Tangent x = Noise(static_cast<int>(test.shape.cols()), 1, 7);
    Eigen::VectorXd jx = derivative.Times(x);
    if (test.metric->options.volume > 0) jx(jx.size() - 1) = 0;  // the last one, of rank one
    const Tangent expected = derivative.TransposeTimes(jx);
    const Eigen::VectorXd got = matrix.selfadjointView<Eigen::Lower>() * x.reshaped();
    EXPECT_LT((got - expected.reshaped()).norm(), 1e-13 * expected.norm());
  }
}

TEST(FeatureMap, RefusesTheRigidMetric) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 3, 1, 1);
  const auto metric = FreezeMetric(MetricOptions::Rigid(), bar.connectivity, {bar.pose(0)});
  const std::string message = testing::MessageOf<InvalidOptions>([&] { FeatureMap map(metric); });
  EXPECT_EQ(message.rfind("rigid:", 0), 0u) << message;
}

}  // namespace
}  // namespace shapespace
