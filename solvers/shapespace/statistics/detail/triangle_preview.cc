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

TriangleFrame Frame(const Shape& shape, const Eigen::Vector3i& corners) {
  return {shape.col(corners(0)), shape.col(corners(1)), shape.col(corners(2))};
}

bool HasArea(const TriangleFrame& frame) {
  return frame.edges.determinant() >
         kNoArea * std::max(frame.edges.col(0).squaredNorm(), frame.edges.col(1).squaredNorm());
}

std::vector<GradientIntegrator::Side> SidesOf(const PoseModes& modes) {
  std::vector<GradientIntegrator::Side> sides;
  const Connectivity& connectivity = *modes.metric->connectivity;
  for (const auto& corners : connectivity.Triangles().colwise()) {
    const double area = 0.5 * std::abs(Frame(modes.mean, corners).edges.determinant());
    for (int k = 0; k < 3; ++k) {
      const int a = corners(k), b = corners((k + 1) % 3);
      const double squared = (modes.mean.col(b) - modes.mean.col(a)).squaredNorm();
      sides.push_back({a, b, squared > 0 ? area / squared : 0});
    }
  }
  for (const auto& side : GradientIntegrator::SidesWithoutTriangles(connectivity)) {
    sides.push_back(side);
  }
  return sides;
}

}  // namespace

TrianglePreview::TrianglePreview(const PoseModes& modes)
    : modes_(modes),
      triangles_(modes.metric->connectivity->Triangles()),
      sides_(triangles_.cols()),
      rotations_(triangles_.cols()),
      changes_(modes.NumModes()),
      integrator_(static_cast<int>(modes.mean.cols()), SidesOf(modes)) {
  for (auto& changes : changes_) changes.setZero(6, triangles_.cols());
  ForIndices(static_cast<int>(triangles_.cols()), [&](int f) {
    const Eigen::Vector3i corners = triangles_.col(f);
    const TriangleFrame mean = Frame(modes.mean, corners);
    rotations_[f] = Eigen::Quaterniond(mean.axes);
    sides_[f] << mean.edges.col(0), mean.edges.col(1) - mean.edges.col(0), -mean.edges.col(1);
    bool has_area = HasArea(mean);
    for (const Shape& pose : modes.poses) has_area = has_area && HasArea(Frame(pose, corners));
    if (!has_area) return;
    const Eigen::Matrix2d inverse = mean.edges.inverse();
    for (int i = 0; i < modes.NumPoses(); ++i) {
      const TriangleDeformation pose(Frame(modes.poses[i], corners), inverse);
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
  Eigen::Matrix3Xd wanted(3, integrator_.Sides().size());
  ForIndices(static_cast<int>(triangles_.cols()), [&](int f) {
    Eigen::Matrix<double, 6, 1> change = Eigen::Matrix<double, 6, 1>::Zero();
    for (Eigen::Index k = 0; k < coordinates.size(); ++k) {
      change += coordinates(k) * changes_[k].col(f);
    }
    const Eigen::Matrix3d turn =
        (rotations_[f] * Exp(Eigen::Vector3d(change.head<3>()))).toRotationMatrix();
    wanted.middleCols<3>(3 * f) = turn.leftCols<2>() *
                                  Exp(SymmetricMatrix2::FromVector(change.tail<3>())).Matrix() *
                                  sides_[f];
  });
  for (Eigen::Index i = 3 * triangles_.cols(); i < wanted.cols(); ++i) {
    const auto& side = integrator_.Sides()[i];
    wanted.col(i) = places.col(side.to) - places.col(side.from);
  }
  const Shape shape = integrator_.Integrate(wanted, places);
  Shape placed = FitRigidMotion(shape, places, modes_.metric->vertex_area)(shape);
  modes_.metric->connectivity->CopyToTwins(&placed);
  return placed;
}

}  // namespace shapespace::internal
