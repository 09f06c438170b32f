#include <shapespace/transfer/internal/gradient_transfer.h>

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/SparseCore>

#include <shapespace/numerics/internal/solve.h>
#include <shapespace/transfer/internal/frames.h>

namespace shapespace::internal {
namespace {

// Lower limits of a triangle's area: this share of its longest side's square, and of the mean area.
// Thinner triangles, on either body, and smaller ones are less reliable.
constexpr double kSliver = 1e-2, kSmall = 1e-3;
// Weight of the vertices' positions relative to the deformation gradients. It only determines the
// position of components, and is too small to have a visible effect otherwise.
constexpr double kPlace = 1e-4;

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
  const double mean_area = num_triangles > 0 ? area.mean() : 0;
  for (int f = 0; f < num_triangles; ++f) {
    // |F - S|^2 as a sum over the sides, weighted by the scalar product of the other two sides
    // (cotangent weights).
    const double counted = std::max({area(f), least(f), kSmall * mean_area}) / quality(f);
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(k, f), b = triangles((k + 1) % 3, f), c = triangles((k + 2) % 3, f);
      const double product = (target_.col(a) - target_.col(c)).dot(target_.col(b) - target_.col(c));
      sides_.push_back({a, b, mean_area * product / (4 * counted * counted)});
    }
  }
  std::vector<bool> in_triangle(num_vertices, false);
  for (const int v : triangles.reshaped()) in_triangle[v] = true;
  for (int e = connectivity_->NumTriangleEdges(); e < connectivity_->NumEdges(); ++e) {
    const int a = connectivity_->Edges()(0, e), b = connectivity_->Edges()(1, e);
    if (!in_triangle[a] || !in_triangle[b]) sides_.push_back({a, b, 1});
  }
  place_ = kPlace / num_vertices;

  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < num_vertices; ++v) entries.emplace_back(v, v, place_);
  for (const auto& [a, b, weight] : sides_) {
    entries.emplace_back(a, a, weight);
    entries.emplace_back(b, b, weight);
    entries.emplace_back(std::max(a, b), std::min(a, b), -weight);
  }
  Eigen::SparseMatrix<double> matrix(num_vertices, num_vertices);
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor_ = std::make_unique<Cholesky>(matrix);
}

Shape GradientTransfer::operator()(const Shape& deformed) const {
  const Eigen::Matrix3Xi& triangles = connectivity_->Triangles();
  Shape right = place_ * (target_ + deformed - source_);
  for (size_t i = 0; i < sides_.size(); ++i) {
    const auto& [a, b, weight] = sides_[i];
    const int f = static_cast<int>(i) / 3;
    Eigen::Vector3d side = target_.col(b) - target_.col(a);
    if (f < triangles.cols()) {
      side = Frame(deformed, triangles.col(f)) * (inverses_[f] * side);
    } else {
      side += (deformed.col(b) - deformed.col(a)) - (source_.col(b) - source_.col(a));
    }
    right.col(b) += weight * side;
    right.col(a) -= weight * side;
  }
  return Solve(*factor_, right.transpose()).transpose();
}

}  // namespace shapespace::internal
