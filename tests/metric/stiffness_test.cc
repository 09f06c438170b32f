#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/metric/metric.h>

#include "support/features.h"
#include "support/message_of.h"
#include "support/stiffened.h"

namespace shapespace {
namespace {

using testing::Get;
using testing::MessageOf;
using testing::Names;

MetricOptions All() {
  MetricOptions options;
  options.isometric = 1;
  options.strain = 0.5;
  options.volume = 0.2;
  return options;
}

TEST(Stiffness, ThatIsTheSameEverywhereIsACoefficient) {
  const ShapeFamily bar = testing::Stiffened(MakeBar(4, 1, 1, 4, 2, 2));
  const std::vector<Shape> poses = {bar.pose(0), bar.pose(50)};
  MetricOptions scaled = All(), placed = All();
  scaled.isometric *= 3;
  scaled.strain *= 3;
  scaled.bending *= 7;
  for (const StiffnessOn on : {StiffnessOn::kVertices, StiffnessOn::kEdges}) {
    const int size = on == StiffnessOn::kVertices ? bar.connectivity->NumVertices()
                                                  : bar.connectivity->NumEdges();
    placed.stiffness_on = on;
    placed.stretching_stiffness.setConstant(size, 3);
    placed.bending_stiffness.setConstant(size, 7);
    const auto expected = FreezeMetric(scaled, bar.connectivity, poses);
    const auto metric = FreezeMetric(placed, bar.connectivity, poses);
    ASSERT_EQ(metric->features.size(), expected->features.size());
    for (size_t i = 0; i < metric->features.size(); ++i) {
      EXPECT_TRUE(metric->features[i]->Weights().isApprox(expected->features[i]->Weights(), 1e-14))
          << metric->features[i]->Name();
    }
  }
}

TEST(Stiffness, WeighsWhatLiesThere) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 4, 1, 1);
  const Connectivity& mesh = *bar.connectivity;
  MetricOptions options = All();
  const auto soft = FreezeMetric(options, bar.connectivity, {bar.pose(0)});
  options.stretching_stiffness.setOnes(mesh.NumVertices());
  options.stretching_stiffness(0) = 5;
  const auto stretched = FreezeMetric(options, bar.connectivity, {bar.pose(0)});
  options.stretching_stiffness.resize(0);
  options.bending_stiffness.setOnes(mesh.NumEdges());
  options.bending_stiffness(2) = 11;
  options.stiffness_on = StiffnessOn::kEdges;
  const auto bent = FreezeMetric(options, bar.connectivity, {bar.pose(0)});
  for (int e = 0; e < mesh.NumEdges(); ++e) {
    const bool there = mesh.Edges()(0, e) == 0 || mesh.Edges()(1, e) == 0;
    EXPECT_NEAR(Get<EdgeLength>(*stretched).weights(e),
                (there ? 3 : 1) * Get<EdgeLength>(*soft).weights(e), 1e-12);
  }
  for (int f = 0; f < mesh.NumTriangles(); ++f) {
    const bool there = (mesh.Triangles().col(f).array() == 0).any();
    EXPECT_NEAR(Get<TriangleStrain>(*stretched).weights(f),
                (there ? (3 + 3 + 1) / 3.0 : 1) * Get<TriangleStrain>(*soft).weights(f), 1e-14);
  }
  for (int h = 0; h < mesh.NumHinges(); ++h) {
    const Eigen::Vector2i edge = mesh.Edges().col(2);
    const Eigen::Vector4i hinge = mesh.Hinges().col(h);
    const bool there = std::minmax(hinge(0), hinge(1)) == std::minmax(edge(0), edge(1));
    EXPECT_NEAR(Get<Dihedral>(*bent).weights(h), (there ? 11 : 1) * Get<Dihedral>(*soft).weights(h),
                1e-18);
  }
}

TEST(Stiffness, MustFitTheMeshAndBePositive) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 4, 1, 1);
  MetricOptions options;
  const auto message = [&] {
    return MessageOf<InvalidOptions>(
        [&] { FreezeMetric(options, bar.connectivity, {bar.pose(0)}); });
  };
  options.stretching_stiffness.setOnes(5);
  EXPECT_TRUE(Names(message(), {"stretching_stiffness:", "5"}));
  options.stretching_stiffness.setOnes(bar.connectivity->NumEdges());
  EXPECT_TRUE(Names(message(), {"vertices"}));
  for (double bad : {0.0, -1.0, double{NAN}, double{INFINITY}}) {
    options.stretching_stiffness.setOnes(bar.connectivity->NumVertices());
    options.stretching_stiffness(3) = bad;
    EXPECT_TRUE(Names(message(), {"stretching_stiffness:", "entry 3"}));
  }
}

// A ring has as many edges as vertices.
TEST(Stiffness, BelongsToWhatItIsSaidToWhereNumbersAgree) {
  const auto ring = Connectivity::Make(4, {0}, {}, {{0, 1}, {1, 2}, {2, 3}, {0, 3}});
  Shape square(3, 4);
  square << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  const auto factors = [&](StiffnessOn on) {
    MetricOptions options;
    options.isometric = 1;
    const auto plain = FreezeMetric(options, ring, {square});
    options.stretching_stiffness = Eigen::Vector4d(1, 1, 9, 1);
    options.stiffness_on = on;
    const auto metric = FreezeMetric(options, ring, {square});
    return Eigen::VectorXd(
        Get<EdgeLength>(*metric).weights.cwiseQuotient(Get<EdgeLength>(*plain).weights));
  };
  Eigen::VectorXd at_vertex = Eigen::VectorXd::Ones(4), on_edge = at_vertex;
  for (int e = 0; e < 4; ++e) {
    if ((ring->Edges().col(e).array() == 2).any()) at_vertex(e) = 5;
  }
  on_edge(2) = 9;
  EXPECT_TRUE(factors(StiffnessOn::kVertices).isApprox(at_vertex, 1e-14));
  EXPECT_TRUE(factors(StiffnessOn::kEdges).isApprox(on_edge, 1e-14));
}

TEST(VertexStiffness, IsTheGeometricMeanOverTheEdges) {
  const auto path = Connectivity::Make(4, {0}, {}, {{0, 1}, {1, 2}});
  const Eigen::VectorXd field = VertexStiffness(Eigen::Vector2d(2, 8), StiffnessOn::kEdges, *path);
  EXPECT_TRUE(field.isApprox(Eigen::Vector4d(2, 4, 8, 1), 1e-14)) << field.transpose();
}

}  // namespace
}  // namespace shapespace
