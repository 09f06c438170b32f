#include <shapespace/hierarchy/internal/detail.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <shapespace/base/internal/ranges.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/rigid_motion.h>

namespace shapespace::internal {
namespace {

constexpr int kVerticesPerTask = 256;
// Weight of the identity in the fit of a rotation, relative to the data.
constexpr double kTurnNothing = 1e-9;

// Barycentric coordinates of the point of triangle (a, b, c) that is closest to p.
Eigen::Vector3d ClosestOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                  const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  // Inside, by the normal equations; else on the nearest side.
  const Eigen::Vector3d e = b - a, f = c - a, d = p - a;
  const double ee = e.squaredNorm(), ef = e.dot(f), ff = f.squaredNorm();
  const double determinant = ee * ff - ef * ef;
  if (determinant > 1e-12 * ee * ff) {
    const double s = (ff * e.dot(d) - ef * f.dot(d)) / determinant;
    const double t = (ee * f.dot(d) - ef * e.dot(d)) / determinant;
    if (s >= 0 && t >= 0 && s + t <= 1) return {1 - s - t, s, t};
  }
  const Eigen::Vector3d* const corners[] = {&a, &b, &c};
  double best = std::numeric_limits<double>::infinity();
  Eigen::Vector3d result(1, 0, 0);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d& from = *corners[k];
    const Eigen::Vector3d side = *corners[(k + 1) % 3] - from;
    const double squared_length = side.squaredNorm();
    const double s =
        squared_length > 0 ? std::clamp((p - from).dot(side) / squared_length, 0.0, 1.0) : 0;
    const double distance = (from + s * side - p).squaredNorm();
    if (distance < best) {
      best = distance;
      result.setZero();
      result(k) = 1 - s;
      result((k + 1) % 3) = s;
    }
  }
  return result;
}

// The rotation nearest to `matrix`: the orthogonal factor of its polar decomposition, by Newton's
// iteration (Higham 1986), which is ten times faster than a singular value decomposition.
// ProcrustesRotation, which uses the latter, is called if the matrix is close to singular or the
// factor is a reflection.
Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& matrix) {
  constexpr double kWellConditioned = 1e-4, kConverged = 1e-14;
  constexpr int kIterations = 12;
  Eigen::Matrix3d x = matrix / matrix.norm();
  if (x.determinant() > kWellConditioned) {
    for (int i = 0; i < kIterations; ++i) {
      Eigen::Matrix3d inverse_transpose;
      inverse_transpose << x.col(1).cross(x.col(2)), x.col(2).cross(x.col(0)),
          x.col(0).cross(x.col(1));
      inverse_transpose /= x.col(0).dot(inverse_transpose.col(0));
      const double scale = std::sqrt(inverse_transpose.norm() / x.norm());
      const Eigen::Matrix3d next = 0.5 * (scale * x + inverse_transpose / scale);
      const double change = (next - x).squaredNorm();
      x = next;
      if (change < kConverged) return x;
    }
  }
  return ProcrustesRotation(matrix.transpose());
}

}  // namespace

Carriers FindCarriers(const Connectivity& coarse, const std::vector<int>& kept,
                      const std::vector<int>& near, const std::vector<Shape>& poses) {
  const int num_fine = static_cast<int>(near.size());
  Carriers result;
  result.vertices.resize(3, num_fine);
  result.weights.resize(3, num_fine);
  std::vector<int> coarse_of(num_fine, -1);
  for (size_t c = 0; c < kept.size(); ++c) coarse_of[kept[c]] = static_cast<int>(c);

  const auto find = [&](int v, std::vector<int>* seen) {
    result.weights.col(v) = Eigen::Vector3d::UnitX();
    if (coarse_of[v] >= 0) {
      result.vertices.col(v).setConstant(coarse_of[v]);
      return;
    }
    result.vertices.col(v).setConstant(near[v]);
    // The nearest triangle at `near`, then at the corners of the triangle found, as long as the
    // distance decreases.
    double best = std::numeric_limits<double>::infinity();
    seen->clear();
    Eigen::Vector3i from = Eigen::Vector3i::Constant(near[v]);
    for (bool better = true; better;) {
      better = false;
      for (int corner : from) {
        if (std::find(seen->begin(), seen->end(), corner) != seen->end()) continue;
        seen->push_back(corner);
        for (const int f : coarse.TrianglesOfVertices()[corner]) {
          const Eigen::Vector3i triangle = coarse.Triangles().col(f);
          double distance = 0;
          Eigen::Vector3d mean = Eigen::Vector3d::Zero();
          for (const Shape& pose : poses) {
            Eigen::Matrix3d corners;
            for (int k = 0; k < 3; ++k) corners.col(k) = pose.col(kept[triangle(k)]);
            const Eigen::Vector3d weights =
                ClosestOnTriangle(pose.col(v), corners.col(0), corners.col(1), corners.col(2));
            distance += (corners * weights - pose.col(v)).squaredNorm();
            mean += weights / poses.size();
          }
          if (distance < best) {
            best = distance;
            result.vertices.col(v) = triangle;
            result.weights.col(v) = mean;
            better = true;
          }
        }
      }
      from = result.vertices.col(v);
    }
  };
  ForRanges(
      num_fine,
      [&](int begin, int end) {
        std::vector<int> seen;  // corners
        for (int v = begin; v < end; ++v) find(v, &seen);
      },
      kVerticesPerTask);
  return result;
}

std::vector<Eigen::Matrix3d> VertexRotations(const Connectivity& coarse, const Shape& rest,
                                             const Shape& moved) {
  const int num_vertices = coarse.NumVertices();
  std::vector<Eigen::Matrix3d> rotations(num_vertices, Eigen::Matrix3d::Zero());
  Eigen::Matrix3Xd rest_normal = Eigen::Matrix3Xd::Zero(3, num_vertices);
  Eigen::Matrix3Xd moved_normal = rest_normal;
  for (int e = 0; e < coarse.NumEdges(); ++e) {
    const int a = coarse.Edges()(0, e), b = coarse.Edges()(1, e);
    const Eigen::Matrix3d product =
        (moved.col(b) - moved.col(a)) * (rest.col(b) - rest.col(a)).transpose();
    rotations[a] += product;
    rotations[b] += product;
  }
  for (int f = 0; f < coarse.NumTriangles(); ++f) {
    const Eigen::Vector3i t = coarse.Triangles().col(f);
    const Eigen::Vector3d n = AreaNormal(rest, t), m = AreaNormal(moved, t);
    for (int v : t) {
      rest_normal.col(v) += n;
      moved_normal.col(v) += m;
    }
  }
  const auto rotate = [&](int v) {
    Eigen::Matrix3d& rotation = rotations[v];
    // Edges of a flat fan do not distinguish rotations from reflections, but the normal does. Its
    // length is twice an area, so that both terms are squared lengths.
    const double norms = std::sqrt(rest_normal.col(v).norm() * moved_normal.col(v).norm());
    if (norms > 0) rotation += moved_normal.col(v) * rest_normal.col(v).transpose() / norms;
    // If neither determines the rotation (edges of a graph on one line), it is the identity.
    rotation.diagonal().array() += kTurnNothing * rotation.norm();
    rotation = NearestRotation(rotation);
  };
  ForIndices(num_vertices, rotate, kVerticesPerTask);
  return rotations;
}

std::vector<Eigen::Matrix3d> VertexGradients(const Connectivity& coarse, const Shape& rest,
                                             const Shape& moved) {
  const std::vector<Eigen::Matrix3d> rotations = VertexRotations(coarse, rest, moved);
  std::vector<Eigen::Matrix3d> products(rotations.size(), Eigen::Matrix3d::Zero());
  std::vector<Eigen::Matrix3d> squares = products;
  for (int e = 0; e < coarse.NumEdges(); ++e) {
    const int a = coarse.Edges()(0, e), b = coarse.Edges()(1, e);
    const Eigen::Vector3d before = rest.col(b) - rest.col(a), after = moved.col(b) - moved.col(a);
    for (int v : {a, b}) {
      products[v] += after * before.transpose();
      squares[v] += before * before.transpose();
    }
  }
  // Where the edges do not determine a direction, such as the normal of a flat fan, the rotation
  // does: F (squares + c I) = products + c R.
  constexpr double kShare = 0.1;
  std::vector<Eigen::Matrix3d> result(rotations.size());
  for (size_t v = 0; v < rotations.size(); ++v) {
    const double trace = squares[v].trace();
    if (!(trace > 0)) {
      result[v] = rotations[v];
      continue;
    }
    const double share = kShare * trace;
    result[v] = (products[v] + share * rotations[v]) *
                (squares[v] + share * Eigen::Matrix3d::Identity()).inverse();
  }
  return result;
}

}  // namespace shapespace::internal
