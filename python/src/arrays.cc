#include "arrays.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include <shapespace/base/error.h>
#include <shapespace/mesh/different_meshes.h>

namespace shapespace::python {
namespace {

std::string ShapeOf(const py::array& array) {
  std::string text;
  for (py::ssize_t i = 0; i < array.ndim(); ++i) {
    text += (i == 0 ? "" : " x ") + std::to_string(array.shape(i));
  }
  return text.empty() ? "a single number" : text;
}

// `value` as an array of numbers; `kinds` are numpy's letters for the kinds of numbers that will
// do.
py::array ToNumbers(py::handle value, const std::string& name, const std::string& kinds,
                    const std::string& what) {
  py::array array = py::array::ensure(value);
  if (!array) {
    PyErr_Clear();
    throw py::type_error(name + ": must be " + what + ", not " +
                         py::cast<std::string>(py::str(py::type::handle_of(value))));
  }
  if (array.size() > 0 && kinds.find(array.dtype().kind()) == kinds.npos) {
    throw py::type_error(name + ": must be " + what + "; its numbers are of type " +
                         py::cast<std::string>(py::str(array.dtype())));
  }
  return array;
}

constexpr char kReal[] = "fiu";

// Up to here every whole number is one of double precision.
constexpr double kMostInFloat = 9007199254740992;

// Rows of three finite numbers.
void Fill(const double* data, const std::string& name, Shape* shape) {
  std::memcpy(shape->data(), data, sizeof(double) * static_cast<size_t>(shape->size()));
  if (shape->allFinite()) return;
  for (int v = 0; v < shape->cols(); ++v) {
    if (shape->col(v).allFinite()) continue;
    std::ostringstream message;
    message << name << ": vertex " << v << " is not finite (" << shape->col(v).transpose() << ")";
    throw MeshError(message.str());
  }
}

void CheckRows(py::ssize_t rows, const std::string& name, int num_vertices) {
  if (num_vertices >= 0 && rows != num_vertices) {
    throw MeshError(name + ": has " + std::to_string(rows) + " vertices, but the mesh has " +
                    std::to_string(num_vertices));
  }
}

[[noreturn]] void RefuseIndex(const std::string& element, std::int64_t index, int num_vertices) {
  const bool known = num_vertices < std::numeric_limits<int>::max();
  throw MeshError(
      element + " names vertex " + std::to_string(index) + ", but " +
      (known ? "there are " + std::to_string(num_vertices) + " vertices, " : "they are ") +
      "counted from 0");
}

// Whole numbers, also such as are stored as floats.
std::vector<std::int64_t> ToIndices(py::handle value, const std::string& name,
                                    const std::string& what) {
  const py::array numbers = ToNumbers(value, name, kReal, what);
  if (numbers.dtype().kind() != 'f') {
    const auto array = Contiguous<std::int64_t>(numbers);
    return {array.data(), array.data() + array.size()};
  }
  const auto array = Contiguous<double>(numbers);
  std::vector<std::int64_t> indices;
  for (py::ssize_t i = 0; i < array.size(); ++i) {
    const double number = array.data()[i];
    if (number != std::trunc(number) || std::abs(number) > kMostInFloat) {
      std::ostringstream message;
      message << name << ": must be " << what << "; " << number << " is no such number";
      throw py::type_error(message.str());
    }
    indices.push_back(static_cast<std::int64_t>(number));
  }
  return indices;
}

}  // namespace

Shape ToShape(py::handle value, const std::string& name, int num_vertices) {
  const std::string what = "an n x 3 array of numbers, one vertex a row";
  const py::array array = ToNumbers(value, name, kReal, what);
  if (array.ndim() != 2 || array.shape(1) != 3) {
    const bool lying = array.ndim() == 2 && array.shape(0) == 3;
    throw py::value_error(name + ": must be " + what + ", not " + ShapeOf(array) +
                          (lying ? "; give its transpose" : ""));
  }
  CheckRows(array.shape(0), name, num_vertices);
  const auto numbers = Contiguous<double>(array);
  Shape shape(3, array.shape(0));
  Fill(numbers.data(), name, &shape);
  return shape;
}

Shape ToPose(py::handle value, const std::string& name, int num_vertices) {
  Shape shape = ToShape(value, name);
  if (shape.cols() != num_vertices) {
    throw MeshError(internal::OfOtherMesh(name, shape.cols(), num_vertices, kCorrespond));
  }
  return shape;
}

std::vector<Shape> ToShapes(py::handle value, const std::string& name, int num_vertices) {
  std::vector<Shape> shapes;
  if (py::isinstance<py::array>(value)) {
    const auto array = py::reinterpret_borrow<py::array>(value);
    if (array.ndim() == 2) {
      throw py::value_error(name + ": must be several n x 3 arrays, not one of " + ShapeOf(array) +
                            "; put it in a list, or give each array by itself and the faces last");
    }
  }
  if (!py::isinstance<py::sequence>(value) && !py::isinstance<py::array>(value)) {
    throw py::type_error(name + ": must be a list of n x 3 arrays, not " +
                         py::cast<std::string>(py::str(py::type::handle_of(value))));
  }
  for (py::handle one : value) {
    const std::string number = NumberedName(name, shapes.size());
    shapes.push_back(shapes.empty() || num_vertices >= 0
                         ? ToShape(one, number, num_vertices)
                         : ToPose(one, number, static_cast<int>(shapes[0].cols())));
  }
  if (shapes.empty()) throw py::value_error(name + ": is empty; give at least one n x 3 array");
  return shapes;
}

void SetPolygons(py::handle faces, Soup* soup, const std::string& name) {
  soup->polygon_begin = {0};
  soup->corners.clear();
  const int num_vertices = soup->NumVertices();
  const auto add = [&](const std::int64_t* corners, size_t count) {
    for (size_t k = 0; k < count; ++k) {
      if (corners[k] < 0 || corners[k] >= num_vertices) {
        RefuseIndex(name + ": face " + std::to_string(soup->NumPolygons()), corners[k],
                    num_vertices);
      }
      soup->corners.push_back(static_cast<int>(corners[k]));
    }
    soup->polygon_begin.push_back(static_cast<int>(soup->corners.size()));
  };
  const std::string what = "an m x 3 array of integers, or a list of polygons";
  const bool ragged = py::isinstance<py::list>(faces) || py::isinstance<py::tuple>(faces);
  if (ragged) {
    for (py::handle face : faces) {
      const std::string own = NumberedName(name, soup->NumPolygons());
      const std::vector<std::int64_t> corners =
          ToIndices(face, own, "the numbers of a polygon's vertices");
      if (corners.size() < 3) throw py::value_error(own + ": has fewer than three vertices");
      add(corners.data(), corners.size());
    }
    return;
  }
  const py::array array = ToNumbers(faces, name, kReal, what);
  if (array.ndim() != 2 || array.shape(1) < 3) {
    throw py::value_error(name + ": must be " + what + ", not " + ShapeOf(array));
  }
  const std::vector<std::int64_t> numbers = ToIndices(array, name, what);
  const auto corners = static_cast<size_t>(array.shape(1));
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    add(numbers.data() + static_cast<size_t>(i) * corners, corners);
  }
}

std::vector<std::pair<int, int>> ToPairs(py::handle value, const std::string& name, int num_first,
                                         int num_second) {
  const std::string what = "a k x 2 array of integers";
  const py::array array = ToNumbers(value, name, kReal, what);
  if (array.size() == 0) return {};
  if (array.ndim() != 2 || array.shape(1) != 2) {
    throw py::value_error(name + ": must be " + what + ", not " + ShapeOf(array));
  }
  const std::vector<std::int64_t> numbers = ToIndices(value, name, what);
  std::vector<std::pair<int, int>> pairs;
  for (size_t i = 0; i < numbers.size(); i += 2) {
    const std::string element = NumberedName(name, i / 2);
    for (int k = 0; k < 2; ++k) {
      const int count = k == 0 ? num_first : num_second;
      if (numbers[i + k] < 0 || numbers[i + k] >= count) {
        RefuseIndex(element, numbers[i + k], count);
      }
    }
    pairs.emplace_back(static_cast<int>(numbers[i]), static_cast<int>(numbers[i + 1]));
  }
  return pairs;
}

std::vector<int> ToVertices(py::handle value, const std::string& name, int num_vertices) {
  const std::string what = "a list of numbers of vertices, or a truth value for each vertex";
  const py::array array = ToNumbers(value, name, "fiub", what);
  if (array.ndim() != 1) {
    throw py::value_error(name + ": must be " + what + ", not " + ShapeOf(array));
  }
  std::vector<int> vertices;
  if (array.dtype().kind() == 'b') {
    CheckRows(array.size(), name, num_vertices);
    const auto chosen = Contiguous<bool>(array);
    for (int v = 0; v < num_vertices; ++v) {
      if (chosen.data()[v]) vertices.push_back(v);
    }
    return vertices;
  }
  for (const std::int64_t vertex : ToIndices(value, name, what)) {
    if (vertex < 0 || vertex >= num_vertices) RefuseIndex(name, vertex, num_vertices);
    vertices.push_back(static_cast<int>(vertex));
  }
  return vertices;
}

Eigen::VectorXi ToIntegers(py::handle value, const std::string& name) {
  const std::string what = "a one-dimensional array of integers";
  const py::array array = ToNumbers(value, name, kReal, what);
  if (array.ndim() != 1) {
    throw py::value_error(name + ": must be " + what + ", not " + ShapeOf(array));
  }
  const std::vector<std::int64_t> numbers = ToIndices(value, name, what);
  Eigen::VectorXi integers(numbers.size());
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] != static_cast<int>(numbers[i])) {
      throw py::value_error(name + ": " + std::to_string(numbers[i]) + " is too large");
    }
    integers[static_cast<Eigen::Index>(i)] = static_cast<int>(numbers[i]);
  }
  return integers;
}

Eigen::VectorXd ToVector(py::handle value, const std::string& name) {
  const std::string what = "a one-dimensional array of numbers";
  const py::array array = ToNumbers(value, name, kReal, what);
  if (array.ndim() != 1) {
    throw py::value_error(name + ": must be " + what + ", not " + ShapeOf(array));
  }
  const auto numbers = Contiguous<double>(array);
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), numbers.size());
}

Eigen::MatrixXd ToMatrix(py::handle value, const std::string& name) {
  const std::string what = "a two-dimensional array of numbers";
  const py::array array = ToNumbers(value, name, kReal, what);
  if (array.ndim() != 2) {
    throw py::value_error(name + ": must be " + what + ", not " + ShapeOf(array));
  }
  const auto numbers = Contiguous<double>(array);
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(numbers.data(), array.shape(0), array.shape(1));
}

py::array_t<double> FromShape(const Shape& shape) { return FromMatrix(shape); }

py::array_t<double> FromShapes(const std::vector<Shape>& shapes) {
  const py::ssize_t vertices = shapes.empty() ? 0 : shapes[0].cols();
  py::array_t<double> array(
      std::vector<py::ssize_t>{static_cast<py::ssize_t>(shapes.size()), vertices, 3});
  double* out = array.mutable_data();
  for (const Shape& shape : shapes) out = std::copy_n(shape.data(), shape.size(), out);
  return array;
}

py::array_t<double> FromVectors(const std::vector<Eigen::VectorXd>& vectors) {
  const py::ssize_t length = vectors.empty() ? 0 : vectors[0].size();
  py::array_t<double> array(
      std::vector<py::ssize_t>{static_cast<py::ssize_t>(vectors.size()), length});
  double* out = array.mutable_data();
  for (const Eigen::VectorXd& vector : vectors) out = std::copy_n(vector.data(), length, out);
  return array;
}

}  // namespace shapespace::python
