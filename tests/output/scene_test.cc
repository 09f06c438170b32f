#include <shapespace/output/detail/ray_scene.h>

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/output/detail/frame.h>
#include <shapespace/output/detail/normals.h>
#include <shapespace/output/internal/text.h>

#include "output/bodies.h"

namespace shapespace {
namespace {

using internal::RayScene;
using internal::RayTracer;

const Eigen::Vector3f kDown(0, 0, -1), kUp(0, 0, 1);

// One triangle in the plane z = 0.25, seen from its front from above; vertex 0 belongs to nothing.
TEST(SceneTest, AHitTellsPlaceValueAndVertex) {
  const auto connectivity = Connectivity::FromTriangles(4, Eigen::Vector3i(1, 2, 3));
  Shape shape(3, 4);
  shape << 0.9, -0.5, 0.5, -0.5, 0.9, -0.5, -0.5, 0.5, 0.9, 0.25, 0.25, 0.25;
  const RayTracer tracer(*connectivity, 0);
  const RayScene scene(tracer, shape, Eigen::Vector4f(100, 1, 10, 4));
  RayScene::Hit hit;
  // A tenth of the way from vertex 1 to 2, and three tenths of that from 1 to 3.
  ASSERT_TRUE(scene.Trace({-0.4f, -0.2f, 1}, kDown, &hit));
  EXPECT_NEAR(hit.distance, 0.75, 1e-5);
  EXPECT_NEAR(hit.value, 0.6 * 1 + 0.1 * 10 + 0.3 * 4, 1e-4);
  EXPECT_EQ(hit.vertex, 1);
  EXPECT_FALSE(hit.back);
  EXPECT_LT((hit.normal - kUp).norm(), 1e-5);
  EXPECT_LT((hit.face_normal - kUp).norm(), 1e-5);
  ASSERT_TRUE(scene.Trace({0.3f, -0.4f, 1}, kDown, &hit));
  EXPECT_EQ(hit.vertex, 2);
  ASSERT_TRUE(scene.Trace({-0.4f, 0.3f, -2}, kUp, &hit));
  EXPECT_EQ(hit.vertex, 3);
  EXPECT_TRUE(hit.back);
  EXPECT_NEAR(hit.distance, 2.25, 1e-5);
  EXPECT_LT((hit.normal - kDown).norm(), 1e-5);
  EXPECT_LT((hit.face_normal - kDown).norm(), 1e-5);
  EXPECT_FALSE(scene.Trace({0.4f, 0.4f, 1}, kDown, &hit));
  EXPECT_TRUE(scene.Blocked({-0.4f, -0.2f, 1}, kDown, 0.76f));
  EXPECT_FALSE(scene.Blocked({-0.4f, -0.2f, 1}, kDown, 0.74f));
  EXPECT_FALSE(scene.Blocked({0.4f, 0.4f, 1}, kDown, 10));
  const RayScene plain(tracer, shape, Eigen::VectorXf());
  ASSERT_TRUE(plain.Trace({-0.4f, -0.2f, 1}, kDown, &hit));
  EXPECT_EQ(hit.value, 0);
}

TEST(SceneTest, TubesAndLooseVerticesOfGraphsAreHit) {
  const auto graph = Connectivity::Make(5, {0}, {}, {{0, 3}, {3, 1}});
  Shape shape(3, 5);
  shape << -0.8, 0, 0.1, 0.8, 0.6, 0, 0.7, 0.5, 0, -0.5, 0, 0, 0, 0, 0;
  const RayTracer tracer(*graph, 0.05f);
  Eigen::VectorXf values(5);
  values << 1, 3, 7, 5, 9;
  const RayScene scene(tracer, shape, values);
  RayScene::Hit hit;
  // A quarter of the way from 0 to 3.
  ASSERT_TRUE(scene.Trace({-0.4f, 0, 1}, kDown, &hit));
  EXPECT_NEAR(hit.distance, 0.95, 1e-3);
  EXPECT_NEAR(hit.value, 2, 1e-2);
  EXPECT_EQ(hit.vertex, 0);
  ASSERT_TRUE(scene.Trace({0.4f, 0, 1}, kDown, &hit));
  EXPECT_NEAR(hit.value, 4, 1e-2);
  EXPECT_EQ(hit.vertex, 3);
  ASSERT_TRUE(scene.Trace({0.1f, 0.5f, 1}, kDown, &hit));
  EXPECT_EQ(hit.vertex, 2);
  EXPECT_EQ(hit.value, 7);
  EXPECT_NEAR(hit.distance, 0.95, 1e-3);
  ASSERT_TRUE(scene.Trace({0.6f, -0.5f, 1}, kDown, &hit));
  EXPECT_EQ(hit.vertex, 4);
  EXPECT_EQ(hit.value, 9);
  EXPECT_FALSE(scene.Trace({-0.4f, 0.06f, 1}, kDown, &hit));
}

// Two slopes of 30 and 50 degrees against a level triangle, of other areas: normals are the means
// weighted by area; a slope of 60 degrees is an edge.
TEST(CornerNormalsTest, AreMeansByAreaUpToSharpEdges) {
  Eigen::Matrix3Xi triangles(3, 2);
  triangles << 0, 1, 1, 0, 2, 3;
  const auto connectivity = Connectivity::FromTriangles(4, triangles);
  const auto normals = [&](double degrees) {
    const double angle = degrees * EIGEN_PI / 180;
    Shape shape(3, 4);
    // The first has an area of 3 / 2, the second of 1 / 2.
    shape << 0, 1, 0.5, 0.5, 0, 0, 3, -std::cos(angle), 0, 0, 0, -std::sin(angle);
    return internal::CornerNormals(*connectivity, shape);
  };
  for (const double degrees : {30.0, 50.0}) {
    const double angle = degrees * EIGEN_PI / 180;
    const Eigen::Vector3f slope(0, static_cast<float>(-std::sin(angle)),
                                static_cast<float>(std::cos(angle)));
    const Eigen::Vector3f mean = (3 * kUp + slope).normalized();
    const Eigen::Matrix3Xf at = normals(degrees);
    EXPECT_LT((at.col(0) - mean).norm(), 1e-5) << degrees;
    EXPECT_LT((at.col(1) - mean).norm(), 1e-5) << degrees;
    EXPECT_LT((at.col(2) - kUp).norm(), 1e-5) << degrees;
    // Of the second triangle, which begins at its least vertex.
    EXPECT_LT((at.col(3) - mean).norm(), 1e-5) << degrees;
    EXPECT_LT((at.col(4) - slope).norm(), 1e-5) << degrees;
  }
  EXPECT_LT((normals(60).col(0) - kUp).norm(), 1e-5);
}

// A picture of one cell in which `shape`, in the unit ball, is seen from +z with y upwards.
class Drawing {
 public:
  Drawing(const SimpleBody& body, const internal::Paint& paint, const Eigen::VectorXf& values = {},
          int samples = 2) {
    const RayTracer tracer(*body.connectivity, 0);
    const RayScene scene(tracer, body.shape, values);
    internal::Camera camera;
    camera.axes = Eigen::Matrix3d::Identity();
    camera.centre = Eigen::Vector2d(0.1, -0.05);
    camera.pixels_per_unit = 50;
    camera.width = 120;
    camera.height = 100;
    camera.samples = samples;
    image_ = {140, 110, std::vector<unsigned char>(3 * 140 * 110, 7)};
    internal::Fill(&image_, 0, 0, 140, 110, internal::Background());
    internal::DrawFrame(scene, camera, paint, 15, 8, &image_);
  }

  // Of the pixel at this place of the world.
  Eigen::Vector3i At(double x, double y) const {
    const int column = 15 + static_cast<int>(60 + 50 * (x - 0.1));
    const int row = 8 + static_cast<int>(50 - 50 * (y + 0.05));
    const unsigned char* p = &image_.pixels[3 * (row * 140 + column)];
    return {p[0], p[1], p[2]};
  }

 private:
  RgbImage image_;
};

::testing::AssertionResult Near(const Eigen::Vector3i& colour, int r, int g, int b) {
  if ((colour - Eigen::Vector3i(r, g, b)).cwiseAbs().maxCoeff() <= 5) {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << "(" << colour.transpose() << ")";
}

// The light comes from the upper left; what it lights has about the colour of the shape's role.
TEST(DrawFrameTest, ASphereIsLitFromTheUpperLeft) {
  const SimpleBody sphere = Sphere(0.8);
  const Drawing pose(sphere, {ShapeRole::kPose, false, {}, {}});
  EXPECT_TRUE(Near(pose.At(0, 0), 76, 131, 194));
  EXPECT_TRUE(Near(pose.At(-0.4, 0.4), 98, 158, 228));
  EXPECT_TRUE(Near(pose.At(0.4, 0.4), 72, 130, 195));
  EXPECT_TRUE(Near(pose.At(-0.4, -0.4), 53, 98, 148));
  EXPECT_TRUE(Near(pose.At(0.4, -0.4), 40, 77, 118));
  EXPECT_TRUE(Near(pose.At(0, 0.7), 83, 148, 221));
  EXPECT_TRUE(Near(pose.At(0.7, 0), 48, 90, 136));
  EXPECT_TRUE(Near(pose.At(-0.7, 0), 72, 131, 195));
  EXPECT_TRUE(Near(pose.At(0, -0.7), 27, 54, 85));
  EXPECT_EQ(pose.At(0.9, 0.9), Eigen::Vector3i::Constant(250));
}

TEST(DrawFrameTest, RolesValuesGroupsAndMarksHaveTheirColours) {
  SimpleBody sphere = Sphere(0.8);
  const auto count = static_cast<int>(sphere.shape.cols());
  const Eigen::VectorXf half = Eigen::VectorXf::Constant(count, 0.5f);
  const Eigen::VectorXi ones = Eigen::VectorXi::Ones(count);
  const auto colour = [&](const internal::Paint& paint) {
    return Drawing(sphere, paint, half).At(0, 0);
  };
  EXPECT_TRUE(Near(colour({ShapeRole::kInserted, false, {}, {}}), 89, 161, 106));
  EXPECT_TRUE(Near(colour({ShapeRole::kExtrapolated, false, {}, {}}), 136, 103, 185));
  EXPECT_TRUE(Near(colour({ShapeRole::kPose, true, {}, {}}), 203, 129, 61));
  EXPECT_TRUE(Near(colour({ShapeRole::kPose, false, ones, {}}), 224, 133, 119));
  EXPECT_TRUE(Near(colour({ShapeRole::kPose, false, {}, ones}), 75, 75, 78));
  EXPECT_TRUE(Near(colour({ShapeRole::kPose, false, {}, 2 * ones}), 203, 64, 64));
  sphere.connectivity = Reversed(*sphere.connectivity);
  for (const ShapeRole role : {ShapeRole::kPose, ShapeRole::kInserted}) {
    EXPECT_TRUE(Near(colour({role, false, {}, ones}), 232, 126, 54));
  }
  EXPECT_TRUE(Near(colour({ShapeRole::kPose, true, {}, {}}), 150, 95, 47));
  EXPECT_TRUE(Near(colour({ShapeRole::kPose, false, ones, {}}), 165, 98, 88));
}

// A plate with a wall on it, which keeps off the key light on its lower right, and the sky near it.
TEST(DrawFrameTest, AWallCastsAShadow) {
  SimpleBody both = Box(1.2, 1.2, 0.1);
  const SimpleBody wall = Box(0.1, 0.6, 0.3);
  Shape shape(3, 16);
  shape << both.shape, wall.shape.colwise() + Eigen::Vector3d(0, 0, 0.2);
  Eigen::Matrix3Xi triangles(3, 24);
  triangles << both.connectivity->Triangles(), wall.connectivity->Triangles().array() + 8;
  both.shape = shape;
  both.connectivity = Connectivity::FromTriangles(16, triangles);
  const Drawing drawing(both, {ShapeRole::kPose, false, {}, {}});
  EXPECT_TRUE(Near(drawing.At(0, 0), 77, 132, 194)) << "on the wall";
  EXPECT_TRUE(Near(drawing.At(-0.4, 0), 77, 132, 194)) << "far from it";
  EXPECT_TRUE(Near(drawing.At(0.5, 0.5), 77, 132, 194)) << "far from it";
  EXPECT_TRUE(Near(drawing.At(-0.1, 0), 73, 125, 184)) << "lit, but near the wall";
  EXPECT_TRUE(Near(drawing.At(0.1, 0), 34, 67, 104)) << "in its shadow";
  EXPECT_TRUE(Near(drawing.At(0.14, -0.2), 37, 72, 111)) << "in its shadow";
  EXPECT_TRUE(Near(drawing.At(0.1, -0.4), 42, 80, 121)) << "in its shadow";
}

}  // namespace
}  // namespace shapespace
