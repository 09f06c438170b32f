#ifndef SHAPESPACE_TESTS_SUPPORT_WORN_H_
#define SHAPESPACE_TESTS_SUPPORT_WORN_H_

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <shapespace/files/read.h>
#include <shapespace/mesh/arrays.h>
#include <shapespace/mesh/shape.h>

// Bodies of several components: what an arm wears, and what is near it.

namespace shapespace::testing {

/// A mesh of triangles.
struct Part {
  Shape vertices;
  Eigen::Matrix3Xi triangles;
};

/// A surface in rows of `around` vertices, each closed to a loop, at(i, angle) for row i. `wraps`:
/// the last row is joined to the first, else both are closed by their middles.
template <typename At>
Part Loops(int rows, int around, bool wraps, const At& at) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k < around; ++k) vertices.push_back(at(i, 2 * M_PI * k / around));
  }
  for (int i = 0; i + (wraps ? 0 : 1) < rows; ++i) {
    for (int k = 0; k < around; ++k) {
      const int l = (k + 1) % around, a = i * around, b = (i + 1) % rows * around;
      triangles.emplace_back(a + k, a + l, b + l);
      triangles.emplace_back(a + k, b + l, b + k);
    }
  }
  for (const int row : {0, rows - 1}) {
    if (wraps) break;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (int k = 0; k < around; ++k) middle += vertices[row * around + k] / around;
    const int tip = static_cast<int>(vertices.size());
    vertices.push_back(middle);
    for (int k = 0; k < around; ++k) {
      const int a = row * around + k, b = row * around + (k + 1) % around;
      triangles.emplace_back(tip, row == 0 ? b : a, row == 0 ? a : b);
    }
  }
  Part part = {Shape(3, vertices.size()), Eigen::Matrix3Xi(3, triangles.size())};
  for (size_t v = 0; v < vertices.size(); ++v) part.vertices.col(v) = vertices[v];
  for (size_t f = 0; f < triangles.size(); ++f) part.triangles.col(f) = triangles[f];
  return part;
}

/// A straight arm along x from -3 to 3, of width 1, in 24 rows of 16 vertices.
inline Part Arm() {
  return Loops(25, 16, false, [](int i, double angle) {
    return Eigen::Vector3d(-3 + 0.25 * i, 0.5 * std::cos(angle), 0.5 * std::sin(angle));
  });
}

/// A ring round the arm at x, turned about it.
inline Part Bracelet(double x, double radius = 0.62, double turn = 0) {
  return Loops(16, 6, true, [=](int i, double angle) {
    const double from_axis = radius + 0.06 * std::cos(angle), a = 2 * M_PI * i / 16 + turn;
    return Eigen::Vector3d(x + 0.06 * std::sin(angle), from_axis * std::cos(a),
                           from_axis * std::sin(a));
  });
}

inline Part Ball(const Eigen::Vector3d& centre, double radius) {
  return Loops(9, 12, false, [&](int i, double angle) -> Eigen::Vector3d {
    const double t = M_PI * (i + 0.5) / 9;
    return centre + radius * Eigen::Vector3d(-std::cos(t), std::sin(t) * std::cos(angle),
                                             std::sin(t) * std::sin(angle));
  });
}

/// The parts as one mesh.
inline Part Together(const std::vector<Part>& parts) {
  Part all;
  for (const Part& part : parts) {
    const int first = static_cast<int>(all.vertices.cols());
    const Eigen::Index triangles = all.triangles.cols();
    all.vertices.conservativeResize(3, first + part.vertices.cols());
    all.vertices.rightCols(part.vertices.cols()) = part.vertices;
    all.triangles.conservativeResize(3, triangles + part.triangles.cols());
    all.triangles.rightCols(part.triangles.cols()) = part.triangles.array() + first;
  }
  return all;
}

/// Bends space about the y axis by an angle in degrees, evenly between x = -.5 and .5.
inline Shape Bent(Shape shape, double degrees) {
  const double angle = degrees * M_PI / 180;
  for (int v = 0; v < shape.cols(); ++v) {
    const double x = shape(0, v), z = shape(2, v);
    if (x <= -0.5 || angle == 0) continue;
    const double turn = angle * std::min(x + 0.5, 1.0), rest = std::max(0.0, x - 0.5);
    shape(0, v) = -0.5 + (1 / angle - z) * std::sin(turn) + rest * std::cos(turn);
    shape(2, v) = 1 / angle - (1 / angle - z) * std::cos(turn) + rest * std::sin(turn);
  }
  return shape;
}

/// Poses of the mesh of the first.
inline Poses PosesOf(const std::vector<Part>& parts, const ReadOptions& options = {}) {
  std::vector<Soup> soups;
  for (const Part& part : parts) {
    soups.push_back(MakeSoup(part.vertices, parts[0].triangles, Layout::kColumns));
  }
  return MakePoses(std::move(soups), options);
}

/// Arm and bracelet, bent.
inline Part BentArmWithBracelet(double degrees, double x = 1.6, double radius = 0.62,
                                double turn = 0) {
  Part part = Together({Arm(), Bracelet(x, radius, turn)});
  part.vertices = Bent(part.vertices, degrees);
  return part;
}

/// By how much the centre of a bracelet at x is off the arm's axis, in widths of the arm, in a
/// shape of arm and bracelet.
inline double BraceletOff(const Shape& shape, double x = 1.6) {
  const int arm = static_cast<int>(Arm().vertices.cols());
  const auto middle = [&](int row) -> Eigen::Vector3d {
    return shape.middleCols(16 * row, 16).rowwise().mean();
  };
  const double at = (x + 3) / 0.25;
  const int row = static_cast<int>(at);
  const Eigen::Vector3d along = middle(row + 1) - middle(row);
  const Eigen::Vector3d off = shape.rightCols(shape.cols() - arm).rowwise().mean() - middle(row);
  return off.cross(along.normalized()).norm();
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_WORN_H_
