// What metrics are made of, and what is said of options that are wrong.

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/metric/metric.h>
#include <shapespace/metric/metric_basis.h>

#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;
using testing::Refuses;

TEST(DescribeMetric, NamesAllThatIsNotTheDefault) {
  EXPECT_EQ(DescribeMetric({}), "strain 1, lambda 0.0001, bending 1e-05");
  EXPECT_EQ(DescribeMetric(MetricOptions::Isometric()),
            "isometric 1, lambda 0.0001, bending 1e-05");
  EXPECT_EQ(DescribeMetric(MetricOptions::Rigid()), "rigid 1, lambda 0.0001");
  EXPECT_EQ(DescribeMetric(MetricOptions::Paper()),
            "isometric 1, lambda 0.001, uniform weights, trapezoid");
  MetricOptions options;
  options.isometric = 0.25;
  options.strain = 0.5;
  options.rigid = 2;
  options.lambda = 0;
  options.bending = 0.125;
  options.volume = 30;
  options.features = {{"one", 3}, {"none", 0}, {"two", 4}};
  options.bending_stiffness = Eigen::VectorXd::Ones(1);
  EXPECT_EQ(DescribeMetric(options),
            "isometric 0.25, strain 0.5, rigid 2, bending 0.125, volume 30, one 3, two 4, "
            "bending stiffness by place");
  options = {};
  options.stretching_stiffness = Eigen::VectorXd::Ones(1);
  EXPECT_EQ(DescribeMetric(options),
            "strain 1, lambda 0.0001, bending 1e-05, stretching stiffness by place");
}

TEST(MetricOptions, OfDeformationsAreThoseOfASolidOrASheet) {
  const ShapeFamily bar = MakeBar(3, 1, 1, 3, 1, 1), sheet = MakeSheet(1, 1, 2, 2);
  EXPECT_EQ(DescribeMetric(MetricOptions::Deformation(*bar.connectivity, bar.pose(0))),
            "isometric 0.3, strain 0.7, bending 7e-05, volume 0.05");
  EXPECT_EQ(DescribeMetric(MetricOptions::Deformation(*sheet.connectivity, sheet.pose(0))),
            "isometric 0.3, strain 0.7, bending 3e-05");
  EXPECT_TRUE(Refuses<MeshError>(
      [&] { MetricOptions::Deformation(*sheet.connectivity, Shape::Zero(3, 8)); }, {"8", "9"}));
}

TEST(MetricOptions, ValidateSaysWhatIsWrongInEachField) {
  const auto message = [](const std::function<void(MetricOptions*)>& change) {
    MetricOptions options;
    change(&options);
    return MessageOf<InvalidOptions>([&] { options.Validate(); });
  };
  const struct {
    double MetricOptions::*field;
    std::string name;
  } fields[] = {{&MetricOptions::isometric, "isometric"}, {&MetricOptions::strain, "strain"},
                {&MetricOptions::rigid, "rigid"},         {&MetricOptions::lambda, "lambda"},
                {&MetricOptions::bending, "bending"},     {&MetricOptions::volume, "volume"}};
  const double infinity = std::numeric_limits<double>::infinity();
  for (const auto& [field, name] : fields) {
    for (const double wrong : {-1e-9, infinity, std::nan("")}) {
      EXPECT_TRUE(Names(message([&, at = field](MetricOptions* o) { o->*at = wrong; }), {name}));
    }
  }
  EXPECT_TRUE(Names(message([](MetricOptions* o) {
                      o->features = {{"one", 1}, {"two", -1}};
                    }),
                    {"features, two:"}));
  EXPECT_TRUE(
      Names(message([](MetricOptions* o) { o->stretching_stiffness = Eigen::Vector3d(1, 2, 0); }),
            {"stretching_stiffness:", "entry 2"}));
  EXPECT_TRUE(Names(
      message([&](MetricOptions* o) { o->bending_stiffness = Eigen::Vector3d(1, infinity, -1); }),
      {"bending_stiffness:", "entry 1"}));
  const auto none = [&](const std::function<void(MetricOptions*)>& change) {
    return message([&](MetricOptions* o) {
      o->strain = o->lambda = 0;
      o->volume = 1;  // bending and volume alone are no metric
      change(o);
    });
  };
  EXPECT_EQ(none([](MetricOptions*) {}),
            "isometric, strain, rigid, lambda: all zero, so motion costs nothing; set one");
  const std::string valid = "nothing was thrown";
  EXPECT_EQ(none([](MetricOptions* o) { o->isometric = 1; }), valid);
  EXPECT_EQ(none([](MetricOptions* o) { o->rigid = 1; }), valid);
  EXPECT_EQ(none([](MetricOptions* o) { o->lambda = 1; }), valid);
}

TEST(FreezeMetric, SaysWhyItRefusesPosesAndStiffness) {
  const ShapeFamily sheet = MakeSheet(1, 1, 2, 2);
  const Shape flat = sheet.pose(0);
  const auto refused = [&](const std::vector<Shape>& poses) {
    return MessageOf<MeshError>([&] { FreezeMetric({}, sheet.connectivity, poses); });
  };
  EXPECT_TRUE(Names(refused({}), {"one pose"}));
  EXPECT_TRUE(Names(refused({flat, Shape::Zero(3, 7)}), {"7", "9"}));
  Shape broken = flat;
  broken(2, 8) = std::nan("");
  EXPECT_TRUE(Names(refused({flat, broken}), {"coordinate"}));
  const std::string magnitude =
      "a pose has coordinates beyond 1e60 or is smaller than 1e-60: scale it";
  EXPECT_EQ(refused({1e61 * flat}), magnitude);
  EXPECT_EQ(refused({flat, 1e-61 * flat}), magnitude);
  EXPECT_EQ(refused({flat.colwise() - Eigen::Vector3d(0, 1e61, 0)}), magnitude);
  EXPECT_TRUE(Names(refused({0 * flat}), {"extent"}));
  MetricOptions options;
  options.bending_stiffness = Eigen::VectorXd::Ones(4);
  const auto stiffness = [&] {
    return MessageOf<InvalidOptions>([&] { FreezeMetric(options, sheet.connectivity, {flat}); });
  };
  const std::string numbers =
      " has 4 numbers; the mesh has 9 vertices and 16 edges, and "
      "stiffness_on says that the numbers belong to ";
  EXPECT_TRUE(Names(stiffness(), {"bending_stiffness:"}));
  options.stretching_stiffness = Eigen::VectorXd::Ones(4);
  options.stiffness_on = StiffnessOn::kEdges;
  EXPECT_TRUE(Names(stiffness(), {"stretching_stiffness:"}));
}

TEST(FreezeMetric, UnitsAndAreasAreMeansOverPoses) {
  Eigen::Matrix3Xi triangles(3, 2);
  triangles.col(0) << 0, 1, 2;
  triangles.col(1) << 1, 3, 2;
  const auto connectivity = Connectivity::FromTriangles(4, triangles);
  Shape pose = Shape::Zero(3, 4);
  pose.row(0) << 0, 2, 0, 4;
  pose.row(1) << 0, 0, 3, 3;  // areas of 3 and 6
  const auto metric = FreezeMetric({}, connectivity, {pose, 3 * pose});
  EXPECT_NEAR(metric->unit, std::sqrt(5 * 9.), 1e-12);
  const Eigen::Vector4d area(3. / 27, 9. / 27, 9. / 27, 6. / 27);
  EXPECT_LT((metric->vertex_area - area).norm(), 1e-12);
  ASSERT_EQ(metric->hinge_area.size(), 1);
  EXPECT_NEAR(metric->hinge_area(0), 1. / 3, 1e-12);
  ASSERT_EQ(metric->edge_area.size(), 5);
  for (int e = 0; e < 5; ++e) {
    const Eigen::Vector2i ends = connectivity->Edges().col(e);
    const bool first = (ends.array() == 0).any(), second = (ends.array() == 3).any();
    EXPECT_NEAR(metric->edge_area(e), first ? 1. / 9 : second ? 2. / 9 : 1. / 3, 1e-12) << e;
  }
  EXPECT_EQ(FreezeMetric({}, connectivity, {pose}, 7)->unit, 7);
}

TEST(Metric, IsInvariantUnderRigidMotionUnlessItHasRigidCostsOrTheTrapezoid) {
  const ShapeFamily sheet = MakeSheet(1, 1, 2, 2);
  const auto invariant = [&](const MetricOptions& options) {
    return FreezeMetric(options, sheet.connectivity, {sheet.pose(0)})
        ->RigidInvariantButForPosition();
  };
  MetricOptions options;
  EXPECT_TRUE(invariant(options));
  options.isometric = 1;
  EXPECT_TRUE(invariant(options));
  options.rigid = 1;
  EXPECT_FALSE(invariant(options));
  options.rigid = 0;
  options.discretization = Discretization::kTrapezoid;
  EXPECT_FALSE(invariant(options));
}

TEST(Stiffness, OfVerticesIsTheGeometricMeanOverTheirEdgesAndOfEdgesTheMeanOfTheirEnds) {
  const auto chain = Connectivity::Make(4, {0}, {}, {{0, 1}, {1, 2}});
  const Eigen::Vector2d edges(2, 32);
  EXPECT_LT(
      (VertexStiffness(edges, StiffnessOn::kEdges, *chain) - Eigen::Vector4d(2, 8, 32, 1)).norm(),
      1e-12);
  const Eigen::Vector4d vertices(1, 3, 7, 5);
  EXPECT_EQ(VertexStiffness(vertices, StiffnessOn::kVertices, *chain), vertices);
  EXPECT_EQ(EdgeStiffness(vertices, StiffnessOn::kVertices, *chain), Eigen::Vector2d(2, 5));
  EXPECT_EQ(EdgeStiffness(edges, StiffnessOn::kEdges, *chain), edges);
}

}  // namespace
}  // namespace shapespace
