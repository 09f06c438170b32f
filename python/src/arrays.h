#ifndef SHAPESPACE_PYTHON_ARRAYS_H_
#define SHAPESPACE_PYTHON_ARRAYS_H_

#include <memory>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

// Between numpy's arrays, one vertex a row, and the library's matrices, one vertex a column: the
// same memory, which is copied as a whole, so that nothing that Python does while a solver runs
// without the interpreter's lock can reach what it works on.

namespace shapespace::python {

namespace py = pybind11;

/// A shape or a tangent from anything that numpy takes for n x 3 integers or floats, in any order
/// of memory. `name` is the argument's, for messages; `num_vertices`, if not negative, what n must
/// be. \throw py::type_error, py::value_error, MeshError (a number is not finite).
Shape ToShape(py::handle value, const std::string& name, int num_vertices = -1);

/// "poses[3]", for messages.
inline std::string NumberedName(const std::string& name, size_t i) {
  return name + "[" + std::to_string(i) + "]";
}

/// The same for a pose of a mesh. \throw MeshError that says what to do with a pose of another
/// mesh.
Shape ToPose(py::handle value, const std::string& name, int num_vertices);

/// What messages name for fitting a mesh onto another one.
constexpr char kCorrespond[] = "correspond";

/// Several shapes of as many vertices: a sequence of n x 3, or one k x n x 3.
std::vector<Shape> ToShapes(py::handle value, const std::string& name, int num_vertices = -1);

/// The polygons of `soup`, which has its vertices, from an m x 3 or m x 4 array of integers, or a
/// sequence of polygons of any numbers of corners. \throw also MeshError if an index is outside.
void SetPolygons(py::handle faces, Soup* soup, const std::string& name = "faces");

/// Pairs of vertices, k x 2. \throw also MeshError if an index is outside.
std::vector<std::pair<int, int>> ToPairs(py::handle value, const std::string& name, int num_first,
                                         int num_second);

/// Numbers of vertices, counted from 0, or the true ones of a truth value a vertex. The largest int
/// as `num_vertices` stands for a mesh that is not known yet. \throw also
/// MeshError if one is outside.
std::vector<int> ToVertices(py::handle value, const std::string& name, int num_vertices);

/// A one-dimensional array of whole numbers.
Eigen::VectorXi ToIntegers(py::handle value, const std::string& name);

/// A one-dimensional array of floats.
Eigen::VectorXd ToVector(py::handle value, const std::string& name);

/// A two-dimensional array of floats, of the same rows.
Eigen::MatrixXd ToMatrix(py::handle value, const std::string& name);

py::array_t<double> FromShape(const Shape& shape);                 ///< n x 3
py::array_t<double> FromShapes(const std::vector<Shape>& shapes);  ///< k x n x 3

/// k x n, from k vectors.
py::array_t<double> FromVectors(const std::vector<Eigen::VectorXd>& vectors);

/// The transpose of any matrix; a vector as one dimension.
template <typename Derived>
py::array_t<typename Derived::Scalar> FromMatrix(const Eigen::MatrixBase<Derived>& matrix) {
  using Scalar = typename Derived::Scalar;
  if (Derived::ColsAtCompileTime == 1) {
    py::array_t<Scalar> array(matrix.rows());
    Eigen::Map<Eigen::Matrix<Scalar, Eigen::Dynamic, 1>>(array.mutable_data(), matrix.rows()) =
        matrix;
    return array;
  }
  py::array_t<Scalar> array(std::vector<py::ssize_t>{matrix.cols(), matrix.rows()});
  Eigen::Map<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>>(
      array.mutable_data(), matrix.rows(), matrix.cols()) = matrix;
  return array;
}

/// A copy of `value` with the memory of all its elements in C order.
template <typename Scalar>
py::array_t<Scalar> Contiguous(py::handle value) {
  auto array = py::array_t<Scalar, py::array::c_style | py::array::forcecast>::ensure(value);
  if (!array) throw py::error_already_set();
  return array;
}

/// The place in a sequence that `i` stands for, which may be counted from the end.
/// \throw py::index_error "`what` i of count".
inline int PositionIn(py::ssize_t i, int count, const std::string& what) {
  if (i < -count || i >= count) {
    throw py::index_error(what + " " + std::to_string(i) + " of " + std::to_string(count));
  }
  return static_cast<int>(i < 0 ? i + count : i);
}

}  // namespace shapespace::python

#endif  // SHAPESPACE_PYTHON_ARRAYS_H_
