#ifndef SHAPESPACE_TESTS_SUPPORT_TRANSFER_CASES_H_
#define SHAPESPACE_TESTS_SUPPORT_TRANSFER_CASES_H_

#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <shapespace/bodies/bar.h>
#include <shapespace/mesh/rigid_motion.h>

#include "support/motions.h"
#include "support/path_of.h"

namespace shapespace::testing {

using Eigen::Matrix3d;
using Eigen::Vector3d;

inline const ShapeFamily& ThickBar() {
  static const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2);
  return bar;
}

// Longer, wider and thinner: the same bend means less strain.
inline Shape ThinBar() { return MakeBar(8, 1.6, 0.6, 12, 2, 2).pose(0); }

// The thick bar, bent by 60 degrees in `steps` steps.
inline Path Bending(int steps) {
  std::vector<Shape> shapes;
  for (int i = 0; i <= steps; ++i) shapes.push_back(ThickBar().pose(60.0 * i / steps));
  return PathOf(ThickBar().connectivity, shapes);
}

inline double Degrees(const Matrix3d& rotation) {
  return std::abs(Eigen::AngleAxisd(rotation).angle()) * 180 / M_PI;
}

// Largest distance between corresponding vertices, over the diameter.
inline double Apart(const Shape& a, const Shape& b) { return Distance(a, b) / Diameter(b); }

// Root mean square distance of the surfaces after alignment, over the diameter.
inline double ShapesApart(const Shape& a, const Shape& b, const Eigen::VectorXd& area) {
  const Shape off = FitRigidMotion(a, b, area)(a) - b;
  return std::sqrt(off.colwise().squaredNorm().dot(area) / area.sum()) / Diameter(b);
}

// The angle between the bar's end faces.
inline double BendOf(const Shape& straight, const Shape& bent) {
  Matrix3d ends[2];
  for (int end : {0, 1}) {
    const double x = end == 0 ? straight.row(0).minCoeff() : straight.row(0).maxCoeff();
    const Eigen::VectorXd face = (straight.row(0).array() == x).cast<double>().transpose();
    ends[end] = FitRigidMotion(straight, bent, face).rotation;
  }
  return Degrees(ends[0].transpose() * ends[1]);
}

inline double StrainOf(const Metric& metric, const Shape& first, const Shape& shape) {
  const Eigen::Matrix2Xi& edges = metric.connectivity->Edges();
  double squares = 0;
  for (int e = 0; e < edges.cols(); ++e) {
    const auto length = [&](const Shape& s) {
      return (s.col(edges(1, e)) - s.col(edges(0, e))).norm();
    };
    squares += metric.edge_area(e) * std::pow(length(shape) / length(first) - 1, 2);
  }
  return std::sqrt(squares / metric.edge_area.sum());
}

// Sumner and Popovic, "Deformation Transfer for Triangle Meshes" (2004): the target whose triangles
// have the source's deformation gradients, in the least squares sense. Every triangle has a fourth
// vertex along its normal; all vertices except the first are unknowns. Both bodies must have the
// same orientation.
class SumnerPopovic {
 public:
  static Shape Transfer(const Connectivity& connectivity, const Shape& source,
                        const Shape& deformed, const Shape& target) {
    const int vertices = connectivity.NumVertices(), triangles = connectivity.NumTriangles();
    std::vector<Eigen::Triplet<double>> entries = {{3 * triangles, 0, 1.0}};
    Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(3 * triangles + 1, 3);
    for (int f = 0; f < triangles; ++f) {
      const Eigen::Vector3i t = connectivity.Triangles().col(f);
      const Matrix3d gradient = Frame(deformed, t) * Frame(source, t).inverse();
      const Matrix3d inverse = Frame(target, t).inverse();
      for (int axis = 0; axis < 3; ++axis) {
        const int row = 3 * f + axis;
        entries.emplace_back(row, t(0), -inverse.col(axis).sum());
        entries.emplace_back(row, t(1), inverse(0, axis));
        entries.emplace_back(row, t(2), inverse(1, axis));
        entries.emplace_back(row, vertices + f, inverse(2, axis));
        wanted.row(row) = gradient.col(axis).transpose();
      }
    }
    Eigen::SparseMatrix<double> matrix(3 * triangles + 1, vertices + triangles);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SparseMatrix<double> normal = matrix.transpose() * matrix;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
    const Eigen::MatrixXd solution = solver.solve(matrix.transpose() * wanted);
    return solution.topRows(vertices).transpose();
  }

 private:
  static Matrix3d Frame(const Shape& shape, const Eigen::Vector3i& t) {
    Matrix3d frame;
    frame.col(0) = shape.col(t(1)) - shape.col(t(0));
    frame.col(1) = shape.col(t(2)) - shape.col(t(0));
    const Vector3d normal = frame.col(0).cross(frame.col(1));
    frame.col(2) = normal / std::sqrt(normal.norm());
    return frame;
  }
};

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_TRANSFER_CASES_H_
