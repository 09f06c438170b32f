#include <shapespace/correspondence/detail/smooth_stretch.h>

#include <algorithm>
#include <utility>

#include <Eigen/Dense>
#include <Eigen/SparseCore>

#include <shapespace/base/parallel.h>
#include <shapespace/sparse/internal/solve.h>
#include <shapespace/transfer/internal/frames.h>

namespace shapespace::internal {
namespace {

// Logarithms of stretches are clamped to this. Larger ones belong to collapsed triangles or wrong
// closest points; proportions of bodies differ by less than a factor of four.
constexpr double kMaxStretch = 1.4;
// Cotangents are at least this. Obtuse triangles and slivers have smaller ones, which would let
// smoothed values leave the range of the values around them.
constexpr double kMinCotangent = 1e-3;

using Sixfold = Eigen::Matrix<double, 6, 1>;

Sixfold Pack(const Eigen::Matrix3d& s) {
  Sixfold packed;
  packed << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2);
  return packed;
}

Eigen::Matrix3d Unpack(const Sixfold& s) {
  Eigen::Matrix3d matrix;
  matrix << s(0), s(3), s(4), s(3), s(1), s(5), s(4), s(5), s(2);
  return matrix;
}

}  // namespace

SmoothStretch::SmoothStretch(std::shared_ptr<const Connectivity> connectivity, Shape rest,
                             double length)
    : connectivity_(std::move(connectivity)), rest_(std::move(rest)) {
  const Eigen::Matrix3Xi& triangles = connectivity_->Triangles();
  const int num_vertices = connectivity_->NumVertices();
  areas_.resize(triangles.cols());
  inverses_.resize(triangles.cols());
  for (int f = 0; f < triangles.cols(); ++f) {
    const Eigen::Matrix3d frame = Frame(rest_, triangles.col(f));
    areas_(f) = 0.5 * frame.col(2).squaredNorm();
    inverses_[f] = InverseFrame(frame);
  }
  const double total = areas_.sum();
  areas_ /= total;
  constexpr double kMinArea = 1e-12;  // for a vertex without triangles
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < num_vertices; ++v) entries.emplace_back(v, v, kMinArea);
  for (int f = 0; f < triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(k, f), b = triangles((k + 1) % 3, f), c = triangles((k + 2) % 3, f);
      const Eigen::Vector3d p = rest_.col(a) - rest_.col(c), q = rest_.col(b) - rest_.col(c);
      const double sine = p.cross(q).norm();
      const double cotangent = sine > 0 ? std::max(kMinCotangent, p.dot(q) / sine) : kMinCotangent;
      const double weight = 0.5 * length * length * std::min(cotangent, 1 / kMinCotangent);
      entries.emplace_back(a, a, weight + areas_(f) / 3);
      entries.emplace_back(b, b, weight);
      entries.emplace_back(std::max(a, b), std::min(a, b), -weight);
    }
  }
  Eigen::SparseMatrix<double> matrix(num_vertices, num_vertices);
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor_ = std::make_unique<Cholesky>(matrix);
}

SmoothStretch::Logarithms SmoothStretch::Raw(const Shape& shape) const {
  const Eigen::Matrix3Xi& triangles = connectivity_->Triangles();
  Logarithms raw(6, triangles.cols());
  ParallelFor(static_cast<int>(triangles.cols()), [&](int f) {
    const Eigen::Matrix3d gradient = Frame(shape, triangles.col(f)) * inverses_[f];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> squared(gradient.transpose() * gradient);
    const Eigen::Vector3d logarithm =
        (0.5 * squared.eigenvalues().array().max(1e-12).log()).max(-kMaxStretch).min(kMaxStretch);
    raw.col(f) =
        Pack(squared.eigenvectors() * logarithm.asDiagonal() * squared.eigenvectors().transpose());
  });
  return raw;
}

Eigen::MatrixXd SmoothStretch::Smoothed(const Logarithms& raw) const {
  const Eigen::Matrix3Xi& triangles = connectivity_->Triangles();
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(rest_.cols(), 6);
  for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      right.row(triangles(k, f)) += areas_(f) / 3 * raw.col(f).transpose();
    }
  }
  return Solve(*factor_, right);
}

double SmoothStretch::Cost(const Shape& shape) const {
  const Eigen::Matrix3Xi& triangles = connectivity_->Triangles();
  const Logarithms raw = Raw(shape);
  const Eigen::MatrixXd smooth = Smoothed(raw);
  double cost = 0;
  for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
    const Sixfold mean = smooth(triangles.col(f), Eigen::all).colwise().mean();
    cost += areas_(f) *
            (std::min(1., Unpack(raw.col(f)).norm()) + Unpack(raw.col(f) - mean).squaredNorm());
  }
  return cost;
}

Eigen::Matrix<double, 9, Eigen::Dynamic> SmoothStretch::StretchedTriangles(
    const Shape& shape) const {
  const Eigen::Matrix3Xi& triangles = connectivity_->Triangles();
  const int num_triangles = connectivity_->NumTriangles();
  const Eigen::MatrixXd smooth = Smoothed(Raw(shape));
  Eigen::Matrix<double, 9, Eigen::Dynamic> stretched(9, num_triangles);
  ParallelFor(num_triangles, [&](int f) {
    Sixfold mean = Sixfold::Zero();
    for (int k = 0; k < 3; ++k) mean += smooth.row(triangles(k, f)).transpose() / 3;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> logarithm(Unpack(mean));
    const Eigen::Matrix3d stretch = logarithm.eigenvectors() *
                                    logarithm.eigenvalues().array().exp().matrix().asDiagonal() *
                                    logarithm.eigenvectors().transpose();
    for (int k = 0; k < 3; ++k) {
      stretched.col(f).segment<3>(3 * k) =
          stretch * (rest_.col(triangles(k, f)) - rest_.col(triangles(0, f)));
    }
  });
  return stretched;
}

}  // namespace shapespace::internal
