#include <shapespace/statistics/detail/triangle_preview.h>

#include <cmath>
#include <utility>

#include <Eigen/LU>

#include <shapespace/base/internal/ranges.h>

namespace shapespace::internal {
namespace {

// A triangle whose area is less than this share of its longest side's square, in the mean or in a
// pose, keeps its sides of the mean.
constexpr double kNoArea = 1e-6;

TriangleFrame PreviewFrame(const Shape& shape, const Eigen::Vector3i& corners) {
  return {shape.col(corners(0)), shape.col(corners(1)), shape.col(corners(2))};
}

bool HasArea(const TriangleFrame& frame) {
  return frame.edges.determinant() >
         kNoArea * std::max(frame.edges.col(0).squaredNorm(), frame.edges.col(1).squaredNorm());
}

Eigen::Matrix3Xd WeightsOfSides(const PoseModes& modes) {
  const Eigen::Matrix3Xi& triangles = modes.metric->connectivity->Triangles();
  Eigen::Matrix3Xd weights(3, triangles.cols());
  for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
    const double area =
        0.5 * std::abs(PreviewFrame(modes.mean, triangles.col(f)).edges.determinant());
    const Eigen::Matrix3d sides = TriangleSides(modes.mean, triangles.col(f));
    for (int k = 0; k < 3; ++k) {
      const double squared = sides.col(k).squaredNorm();
      weights(k, f) = squared > 0 ? area / squared : 0;
    }
  }
  return weights;
}

}  // namespace

TrianglePreview::TrianglePreview(const PoseModes& modes)
    : modes_(modes),
      triangles_(modes.metric->connectivity->Triangles()),
      rotations_(triangles_.cols()),
      changes_(modes.NumModes()),
      integrator_(*modes.metric->connectivity, WeightsOfSides(modes)) {
  for (auto& changes : changes_) changes.setZero(6, triangles_.cols());
  ForIndices(static_cast<int>(triangles_.cols()), [&](int f) {
    const Eigen::Vector3i corners = triangles_.col(f);
    const TriangleFrame mean = PreviewFrame(modes.mean, corners);
    rotations_[f] = Eigen::Quaterniond(mean.axes);
    bool has_area = HasArea(mean);
    for (const Shape& pose : modes.poses) {
      has_area = has_area && HasArea(PreviewFrame(pose, corners));
    }
    if (!has_area) return;
    const Eigen::Matrix2d inverse = mean.edges.inverse();
    for (int i = 0; i < modes.NumPoses(); ++i) {
      const TriangleDeformation pose(PreviewFrame(modes.poses[i], corners), inverse);
      Eigen::Matrix<double, 6, 1> change;
      change << Log(rotations_[f].conjugate() * pose.rotation), Log(pose.stretch).Vector();
      for (int k = 0; k < modes.NumModes(); ++k) {
        changes_[k].col(f) += modes.coefficients(i, k) * change;
      }
    }
  });
}

Shape TrianglePreview::At(const Eigen::VectorXd& coordinates) const {
  Shape places = modes_.mean;
  for (Eigen::Index k = 0; k < coordinates.size(); ++k) places += coordinates(k) * modes_.modes[k];
  const auto gradient = [&](int f) -> Eigen::Matrix3d {
    Eigen::Matrix<double, 6, 1> change = Eigen::Matrix<double, 6, 1>::Zero();
    for (Eigen::Index k = 0; k < coordinates.size(); ++k) {
      change += coordinates(k) * changes_[k].col(f);
    }
    Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
    stretch.topLeftCorner<2, 2>() = Exp(SymmetricMatrix2::FromVector(change.tail<3>())).Matrix();
    const Eigen::Matrix3d plane = rotations_[f].toRotationMatrix();
    return plane * Exp(Eigen::Vector3d(change.head<3>())) * stretch * plane.transpose();
  };
  const auto sides = [&](int f) -> Eigen::Matrix3d {
    return gradient(f) * TriangleSides(modes_.mean, triangles_.col(f));
  };
  const Shape shape = integrator_.Integrate(modes_.mean, places, sides, gradient);
  return FitRigidMotion(shape, places, modes_.metric->vertex_area)(shape);
}

}  // namespace shapespace::internal
