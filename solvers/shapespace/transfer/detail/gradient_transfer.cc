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
  const int num_vertices = connectivity_->NumVertices();
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
  // Three per triangle, then the edges without triangles.
  std::vector<GradientIntegrator::Side> sides;
  const double mean_area = num_triangles > 0 ? area.mean() : 0;
  for (int f = 0; f < num_triangles; ++f) {
    // |F - S|^2 as a sum over the sides, weighted by the scalar product of the other two sides
    // (cotangent weights).
    const double counted = std::max({area(f), least(f), kSmall * mean_area}) / quality(f);
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(k, f), b = triangles((k + 1) % 3, f), c = triangles((k + 2) % 3, f);
      const double product = (target_.col(a) - target_.col(c)).dot(target_.col(b) - target_.col(c));
      sides.push_back({a, b, mean_area * product / (4 * counted * counted)});
    }
  }
  for (const auto& side : GradientIntegrator::SidesWithoutTriangles(*connectivity_)) {
    sides.push_back(side);
  }
  first_tie_ = sides.size();
  for (const auto& tie : GradientIntegrator::Ties(*connectivity_)) sides.push_back(tie);
  integrator_ = std::make_unique<GradientIntegrator>(num_vertices, std::move(sides));
}

Shape GradientTransfer::operator()(const Shape& deformed) const {
  const Eigen::Matrix3Xi& triangles = connectivity_->Triangles();
  const std::vector<GradientIntegrator::Side>& sides = integrator_->Sides();
  Eigen::Matrix3Xd wanted(3, sides.size());
  const auto gradient = [&](int f) -> Eigen::Matrix3d {
    return Frame(deformed, triangles.col(f)) * inverses_[f];
  };
  for (size_t i = 0; i < sides.size(); ++i) {
    const auto& [a, b, weight] = sides[i];
    const int f = static_cast<int>(i) / 3;
    Eigen::Vector3d side = target_.col(b) - target_.col(a);
    if (f < triangles.cols()) {
      side = Frame(deformed, triangles.col(f)) * (inverses_[f] * side);
    } else if (i >= first_tie_) {
      side = GradientIntegrator::AlongTie(*connectivity_, sides[i], side, gradient);
    } else {
      side += (deformed.col(b) - deformed.col(a)) - (source_.col(b) - source_.col(a));
    }
    wanted.col(static_cast<Eigen::Index>(i)) = side;
  }
  Shape shape = integrator_->Integrate(wanted, target_ + deformed - source_);
  connectivity_->CopyToTwins(&shape);
  return shape;
}

}  // namespace shapespace::internal
