#include <shapespace/output/detail/normals.h>

#include <gtest/gtest.h>

#include "output/bodies.h"

namespace shapespace {
namespace {

TEST(CornerNormalsTest, AreRadialOnASphere) {
  const SimpleBody sphere = Sphere(2);
  const Eigen::Matrix3Xf normals = internal::CornerNormals(*sphere.connectivity, sphere.shape);
  const Eigen::Matrix3Xi& triangles = sphere.connectivity->Triangles();
  for (Eigen::Index i = 0; i < normals.cols(); ++i) {
    // Triangles without area, at the poles, have no normal of their own.
    if (normals.col(i).isZero()) continue;
    const Eigen::Vector3f radial = sphere.shape.col(triangles.data()[i]).cast<float>() / 2;
    EXPECT_GT(normals.col(i).dot(radial), 0.998f) << i;
  }
}

TEST(CornerNormalsTest, AreThoseOfTheFacesOnABox) {
  const SimpleBody box = Box(3, 2, 1);
  const Eigen::Matrix3Xf normals = internal::CornerNormals(*box.connectivity, box.shape);
  const Eigen::Matrix3Xi& triangles = box.connectivity->Triangles();
  for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) centre += box.shape.col(triangles(k, f)).cwiseSign() / 3;
    // The three corners of a face share exactly one sign.
    const Eigen::Vector3f outward =
        (centre.array().abs() > 0.99).select(centre, 0).cast<float>().matrix();
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(normals.col(3 * f + k).isApprox(outward)) << f;
  }
}

TEST(CornerNormalsTest, AreZeroWithoutArea) {
  Eigen::Matrix3Xi triangle(3, 1);
  triangle << 0, 1, 2;
  const auto connectivity = Connectivity::FromTriangles(3, triangle);
  const Shape line = Shape::Ones(3, 3) * Eigen::Vector3d(0, 1, 2).asDiagonal();
  EXPECT_TRUE(internal::CornerNormals(*connectivity, line).isZero(0));
}

}  // namespace
}  // namespace shapespace
