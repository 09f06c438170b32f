#include <shapespace/transfer/detail/gradient_transfer.h>

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/transfer/internal/frames.h>

namespace shapespace::internal {
namespace {

// Lower limits of a triangle's area: this share of its longest side's square, and of the mean area.
// Thinner triangles, on either body, and smaller ones are less reliable.
constexpr double kSliver = 1e-2, kSmall = 1e-3;

}  // namespace

GradientTransfer::GradientTransfer(std::shared_ptr<const Connectivity> connectivity,
                                   const Shape& source, const Shape& target)
    : connectivity_(std::move(connectivity)), source_(source), target_(target) {
  const int num_triangles = connectivity_->NumTriangles();
  const Eigen::Matrix3Xi& triangles = connectivity_->Triangles();
  Eigen::VectorXd area(num_triangles), least(num_triangles), quality(num_triangles);
  for (int f = 0; f < num_triangles; ++f) {
    const auto measure = [&](const Shape& shape, double* sliver) {
      const Eigen::Matrix3d frame = Frame(shape, triangles.col(f));
      *sliver = kSliver * std::max({frame.col(0).squaredNorm(), frame.col(1).squaredNorm(),
                                    (frame.col(1) - frame.col(0)).squaredNorm()});
      return 0.5 * frame.col(0).cross(frame.col(1)).norm();
    };
    area(f) = measure(target_, &least(f));
    double sliver;
    const double source_area = measure(source_, &sliver);
    quality(f) = source_area < sliver ? source_area / sliver : 1;
    inverses_.push_back(InverseFrame(Frame(source_, triangles.col(f))));
  }
  Eigen::Matrix3Xd weights(3, num_triangles);
  const double mean_area = num_triangles > 0 ? area.mean() : 0;
  for (int f = 0; f < num_triangles; ++f) {
    // |F - S|^2 as a sum over the sides, weighted by the scalar product of the other two sides
    // (cotangent weights).
    const double counted = std::max({area(f), least(f), kSmall * mean_area}) / quality(f);
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(k, f), b = triangles((k + 1) % 3, f), c = triangles((k + 2) % 3, f);
      const double product = (target_.col(a) - target_.col(c)).dot(target_.col(b) - target_.col(c));
      weights(k, f) = mean_area * product / (4 * counted * counted);
    }
  }
  integrator_ = std::make_unique<SurfaceIntegrator>(*connectivity_, weights);
}

Shape GradientTransfer::operator()(const Shape& deformed) const {
  const auto gradient = [&](int f) -> Eigen::Matrix3d {
    return Frame(deformed, connectivity_->Triangles().col(f)) * inverses_[f];
  };
  const auto sides = [&](int f) -> Eigen::Matrix3d {
    return gradient(f) * TriangleSides(target_, connectivity_->Triangles().col(f));
  };
  return integrator_->Integrate(target_, target_ + deformed - source_, sides, gradient);
}

}  // namespace shapespace::internal
