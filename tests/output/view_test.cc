#include <shapespace/output/internal/view.h>

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <shapespace/files/read.h>

#include "output/bodies.h"

namespace shapespace {
namespace {

// A post on z with a heavy arm towards +y, so that it would fall over on any other side.
SimpleBody Gallows() {
  SimpleBody body = Box(0.3, 0.3, 3);
  const SimpleBody arm = Box(0.2, 1, 0.2), foot = Box(0.6, 1.4, 0.1);
  const int count = body.connectivity->NumTriangles();
  Shape shape(3, 24);
  shape << body.shape, arm.shape.colwise() + Eigen::Vector3d(0, 0.6, 1),
      foot.shape.colwise() + Eigen::Vector3d(0, 0, -1.5);
  Eigen::Matrix3Xi triangles(3, 3 * count);
  for (int k = 0; k < 3; ++k) {
    triangles.middleCols(k * count, count) = body.connectivity->Triangles().array() + 8 * k;
  }
  body.shape = shape;
  body.connectivity = Connectivity::FromTriangles(24, triangles);
  return body;
}

Shape WithZAsY(const Shape& shape) {
  Shape turned = shape;
  turned.row(1) = shape.row(2);
  turned.row(2) = -shape.row(1);
  return turned;
}

internal::Axes View(const SimpleBody& body, const Eigen::Vector3d& up) {
  const internal::RayTracer tracer(*body.connectivity, 0);
  const std::vector<Shape> shapes = {body.shape / body.shape.colwise().norm().maxCoeff()};
  std::vector<internal::RayScene> scenes;
  scenes.emplace_back(tracer, shapes[0], Eigen::VectorXf());
  return internal::ChooseView(*body.connectivity, shapes, scenes, up);
}

TEST(ChooseUpTest, PrefersYWhereNothingSpeaksAgainst) {
  const SimpleBody box = Box(1, 2, 3);
  EXPECT_EQ(internal::ChooseUp(*box.connectivity, {box.shape}), Eigen::Vector3d::UnitY());
}

TEST(ChooseUpTest, IsTheAxisOnWhichTheBodyStands) {
  const SimpleBody gallows = Gallows();
  EXPECT_EQ(internal::ChooseUp(*gallows.connectivity, {gallows.shape}), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(internal::ChooseUp(*gallows.connectivity, {WithZAsY(gallows.shape)}),
            Eigen::Vector3d::UnitY());
}

TEST(ChooseUpTest, DoesNotDependOnPlaceAndUnits) {
  const SimpleBody gallows = Gallows();
  const Shape moved = (1e3 * gallows.shape).colwise() + Eigen::Vector3d(700, -4000, 90);
  EXPECT_EQ(internal::ChooseUp(*gallows.connectivity, {moved}), Eigen::Vector3d::UnitZ());
}

TEST(ChooseUpTest, IsRightForRealMeshes) {
  if (!std::filesystem::is_directory(SHAPESPACE_DATA_DIR)) {
    GTEST_SKIP() << "no real meshes";
  }
  using Files = std::vector<std::string>;
  const auto up = [](const Files& names) {
    Files files;
    for (const std::string& name : names) {
      files.push_back(std::string(SHAPESPACE_DATA_DIR) + "/" + name + ".obj");
    }
    ReadOptions options;
    options.allow_nonmanifold = true;
    const Poses poses = ReadPoses(files, options);
    return internal::ChooseUp(*poses.connectivity, poses.shapes);
  };
  for (const Files& names :
       {Files{"human/000", "human/007"}, Files{"cat/reference", "cat/02"},
        Files{"horse/reference", "horse/01"}, Files{"lion/reference", "lion/02"},
        Files{"elephant/reference", "elephant/02"}, Files{"armadillo/rest", "armadillo/kick"},
        Files{"horse_lowpoly/base", "horse_lowpoly/m05"},
        Files{"camel_nonmanifold/reference", "camel_nonmanifold/01"}, Files{"human_b/024"}}) {
    EXPECT_EQ(up(names), Eigen::Vector3d::UnitY()) << names[0];
  }
  for (const Files& names : {Files{"scape/ref", "scape/6"}, Files{"cactus/00", "cactus/08"}}) {
    EXPECT_EQ(up(names), Eigen::Vector3d::UnitZ()) << names[0];
  }
}

TEST(LookFromTest, HasTheEyeInFrontAndUpInTheUpperHalf) {
  const internal::Axes axes = internal::LookFrom({3, 1, 2}, {0, 5, 0});
  EXPECT_TRUE((axes.transpose() * axes).isIdentity(1e-12));
  EXPECT_NEAR(axes.determinant(), 1, 1e-12);
  EXPECT_TRUE(axes.col(2).isApprox(Eigen::Vector3d(3, 1, 2).normalized()));
  EXPECT_EQ(axes(1, 0), 0);
  EXPECT_GT(axes(1, 1), 0);
}

TEST(ChooseViewTest, NeverSeesAPlateFromItsEdge) {
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d size(2, 2, 2);
    size[axis] = 0.01;
    const SimpleBody plate = Box(size.x(), size.y(), size.z());
    for (const Eigen::Vector3d& up : {Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)}) {
      EXPECT_GT(std::abs(View(plate, up)(axis, 2)), 0.7) << axis << ", " << up.transpose();
    }
  }
}

TEST(ChooseViewTest, IsThreeQuarterFromTheFront) {
  const SimpleBody box = Box(1, 1.5, 1);
  const Eigen::Vector3d y_up = View(box, Eigen::Vector3d::UnitY()).col(2);
  EXPECT_GT(y_up.z(), 0.2);
  EXPECT_GT(y_up.y(), 0.2);
  EXPECT_GT(std::abs(y_up.x()), 0.2);
  const Eigen::Vector3d z_up = View(Box(1, 1, 1.5), Eigen::Vector3d::UnitZ()).col(2);
  EXPECT_LT(z_up.y(), -0.2);
  EXPECT_GT(z_up.z(), 0.2);
}

TEST(ChooseViewTest, SeesAnOpenSheetFromItsFront) {
  Eigen::Matrix3Xi triangles(3, 2);
  triangles << 0, 0, 1, 2, 2, 3;
  SimpleBody sheet;
  sheet.connectivity = Connectivity::FromTriangles(4, triangles);
  sheet.shape.resize(3, 4);
  sheet.shape << -1, 1, 1, -1, -1, -1, 1, 1, 0, 0, 0, 0;
  EXPECT_GT(View(sheet, Eigen::Vector3d::UnitY())(2, 2), 0);
  sheet.connectivity = Reversed(*sheet.connectivity);
  EXPECT_LT(View(sheet, Eigen::Vector3d::UnitY())(2, 2), 0);
}

// Half of a sphere, which is open towards `-axis`.
SimpleBody Bowl(const Eigen::Vector3d& axis) {
  SimpleBody bowl = Sphere(1, 21, 40);
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitY(), axis).toRotationMatrix();
  bowl.shape = turn * bowl.shape;
  std::vector<Eigen::Vector3i> upper;
  for (const auto& corners : bowl.connectivity->Triangles().colwise()) {
    const Eigen::Vector3d middle =
        (bowl.shape.col(corners[0]) + bowl.shape.col(corners[1]) + bowl.shape.col(corners[2]));
    if (middle.dot(axis) > 0) upper.push_back(corners);
  }
  Eigen::Matrix3Xi triangles(3, upper.size());
  for (size_t i = 0; i < upper.size(); ++i) triangles.col(i) = upper[i];
  bowl.connectivity = Connectivity::FromTriangles(static_cast<int>(bowl.shape.cols()), triangles);
  return bowl;
}

// A scan of a face is such a surface, however it lies.
TEST(ChooseViewTest, SeesAnOpenSurfaceFromOutside) {
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0, 1, 0),
        Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1),
        Eigen::Vector3d(0.2, -0.33, -0.92).normalized()}) {
    const SimpleBody bowl = Bowl(axis);
    for (const Eigen::Vector3d& up :
         {Eigen::Vector3d(Eigen::Vector3d::UnitY()), Eigen::Vector3d(Eigen::Vector3d::UnitZ())}) {
      EXPECT_GT(View(bowl, up).col(2).dot(axis), 0.2) << axis.transpose() << "; " << up.transpose();
    }
    const Eigen::Vector3d chosen = internal::ChooseUp(*bowl.connectivity, {bowl.shape});
    EXPECT_GT(chosen.dot(axis), -0.5) << axis.transpose();
  }
}

// Closed surfaces have no side that is hidden, so that they are seen from above as before.
TEST(ChooseViewTest, SeesAClosedSurfaceFromAbove) {
  EXPECT_GT(View(Sphere(1, 20, 40), Eigen::Vector3d::UnitY())(1, 2), 0);
}

// Where neither side has more to show, the body is seen from its left, low, and so faces right.
TEST(ChooseViewTest, FacesRightWhereNothingSpeaksAgainst) {
  const SimpleBody sphere = Sphere(1, 20, 40);
  const auto at = [](double azimuth, double elevation) -> Eigen::Vector3d {
    const double a = azimuth * EIGEN_PI / 180, e = elevation * EIGEN_PI / 180;
    return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
  };
  const Eigen::Vector3d y_up = View(sphere, Eigen::Vector3d::UnitY()).col(2);
  EXPECT_LT(std::min((y_up - at(-30, 15)).norm(), (y_up - at(-60, 15)).norm()), 1e-12);
  // With z upwards, the front is at -y.
  const Eigen::Vector3d z_up = View(sphere, Eigen::Vector3d::UnitZ()).col(2);
  const Eigen::Vector3d turned(z_up.x(), z_up.z(), -z_up.y());
  EXPECT_LT(std::min((turned - at(-30, 15)).norm(), (turned - at(-60, 15)).norm()), 1e-12);
}

TEST(ChooseUpTest, AllShapesAreAskedAndATieIsY) {
  const SimpleBody gallows = Gallows();
  const Shape other = WithZAsY(gallows.shape);
  EXPECT_EQ(internal::ChooseUp(*gallows.connectivity, {gallows.shape, other}),
            Eigen::Vector3d::UnitY());
  EXPECT_EQ(internal::ChooseUp(*gallows.connectivity, {gallows.shape, other, gallows.shape}),
            Eigen::Vector3d::UnitZ());
}

}  // namespace
}  // namespace shapespace
