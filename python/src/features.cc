#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include <shapespace/metric/feature_registry.h>

#include "arrays.h"
#include "bind.h"

// Features that are functions of Python's. `shapespace._features` checks what they return, so that
// all that goes wrong is an exception of Python's.

namespace shapespace::python {
namespace {

// What is common to a feature on all meshes.
struct Definition {
  std::string name;
  int vertices = 0, values = 0;
  bool is_rigid_invariant = true, is_sum = false;
  std::vector<std::string> constants;
  py::object evaluate;  // (x, constants) -> values, derivatives: by element, by vertex, by value
  py::object freeze;    // (basis) -> elements, weights, constants
};

// Solvers delete their metrics in threads that do not hold the interpreter's lock.
std::shared_ptr<const Definition> Share(Definition definition) {
  return {new Definition(std::move(definition)), [](const Definition* shared) {
            if (!Py_IsInitialized()) return;  // the process ends, and frees it
            const py::gil_scoped_acquire locked;
            delete shared;
          }};
}

// What body() returns, which runs with the interpreter's lock. \throw RaisedInPython, which library
// and solvers let pass.
template <typename Body>
auto WithLock(const Body& body) {
  const py::gil_scoped_acquire locked;
  try {
    return body();
  } catch (py::error_already_set& error) {
    throw RaisedInPython{std::make_shared<py::error_already_set>(std::move(error))};
  }
}

class PythonFeature final : public Feature {
 public:
  PythonFeature(std::shared_ptr<const Definition> definition, Eigen::MatrixXi stencils,
                Eigen::VectorXd weights, std::vector<double> constants)
      : definition_(std::move(definition)),
        own_stencils_(std::move(stencils)),
        own_weights_(std::move(weights)),
        constants_(std::move(constants)) {
    name_ = definition_->name;
    vertices_ = definition_->vertices;
    values_ = definition_->values;
    num_elements_ = static_cast<int>(own_stencils_.cols());
    scalar_rows_ = 3 * values_;
    is_sum_ = definition_->is_sum;
    is_rigid_invariant_ = definition_->is_rigid_invariant;
    stencils_ = own_stencils_.data();
    weights_ = &own_weights_;
  }

  void Evaluate(int count, const double* x, double* values, double* derivatives) const override {
    WithLock([&] {
      const py::array_t<double> sites(std::vector<py::ssize_t>{count, vertices_, 3}, x);
      py::dict constants;
      for (const auto& [name, number] : Constants()) constants[name.c_str()] = number;
      const auto [all, slopes] = py::cast<std::pair<py::array_t<double>, py::array_t<double>>>(
          definition_->evaluate(sites, constants));
      std::copy_n(all.data(), all.size(), values);
      if (derivatives != nullptr) std::copy_n(slopes.data(), slopes.size(), derivatives);
    });
  }

  // Central differences of the derivatives, whose step is a share of the element's size: the root
  // of the rounding error of a derivative would be best for one-sided differences, its third root
  // is for these.
  void SecondDerivatives(int count, const double* x, const double* along,
                         double* values) const override {
    constexpr double kStep = 6e-6;
    const int size = 3 * vertices_;
    std::vector<double> steps(count), at(2 * static_cast<size_t>(size) * count);
    const auto put = [&](size_t place) {
      return Eigen::Map<Eigen::VectorXd>(&at[place * size], size);
    };
    for (size_t e = 0; e < steps.size(); ++e) {
      const Eigen::Map<const Eigen::Matrix3Xd> vertices(x + e * size, 3, vertices_);
      const Eigen::Map<const Eigen::VectorXd> here(x + e * size, size), way(along + e * size, size);
      const double extent = (vertices.colwise() - vertices.col(0)).norm();
      const double longest = way.lpNorm<Eigen::Infinity>();
      // The metric's unit of length stands for the size of a vertex.
      if (longest > 0) steps[e] = kStep * (extent > 0 ? extent : 1) / longest;
      put(2 * e) = here - steps[e] * way;
      put(2 * e + 1) = here + steps[e] * way;
    }
    std::vector<double> ignored(2 * static_cast<size_t>(values_) * count);
    std::vector<double> derivatives(ignored.size() * size);
    Evaluate(2 * count, at.data(), ignored.data(), derivatives.data());
    const size_t block = static_cast<size_t>(values_) * size;
    for (size_t e = 0; e < steps.size(); ++e) {
      const double* const before = &derivatives[2 * e * block];
      for (int k = 0; k < values_; ++k) {
        double difference = 0;
        for (int i = 0; i < size; ++i) {
          const int place = 3 * (i / 3 * values_ + k) + i % 3;
          difference += (before[block + place] - before[place]) * along[e * size + i];
        }
        *values++ = steps[e] > 0 ? difference / (2 * steps[e]) : 0;
      }
    }
  }

  // The straight chord, which holds for any feature.
  double LeastChange(int count, const double* a, const double* b, const double* weights,
                     int segments) const override {
    double sum = 0;
    for (int e = 0; e < count; ++e) {
      for (int k = 0; k < values_; ++k, ++a, ++b) sum += weights[e] * (*b - *a) * (*b - *a);
    }
    return sum / segments;
  }

  std::vector<std::pair<std::string, double>> Constants() const override {
    std::vector<std::pair<std::string, double>> named;
    for (size_t i = 0; i < constants_.size(); ++i) {
      named.emplace_back(definition_->constants[i], constants_[i]);
    }
    return named;
  }

 private:
  const void* StructIf(const std::type_info& /*type*/) const override { return nullptr; }

  const std::shared_ptr<const Definition> definition_;
  const Eigen::MatrixXi own_stencils_;
  const Eigen::VectorXd own_weights_;
  const std::vector<double> constants_;  // in the order of their names
};

internal::FeatureKind KindOf(const std::shared_ptr<const Definition>& definition) {
  internal::FeatureKind kind;
  kind.vertices = definition->vertices;
  kind.is_sum = definition->is_sum;
  kind.freeze = [definition](const MetricBasis& basis, double coefficient) {
    return WithLock([&]() -> std::shared_ptr<const Feature> {
      const auto [elements, weights, constants] =
          py::cast<std::tuple<py::array_t<int>, py::array_t<double>, std::vector<double>>>(
              definition->freeze(basis));
      Eigen::MatrixXi stencils(definition->vertices, elements.size() / definition->vertices);
      std::copy_n(elements.data(), elements.size(), stencils.data());
      Eigen::VectorXd scaled(weights.size());
      std::copy_n(weights.data(), weights.size(), scaled.data());
      return std::make_shared<PythonFeature>(definition, std::move(stencils), coefficient * scaled,
                                             constants);
    });
  };
  kind.restore = [definition](const Eigen::MatrixXi& stencils, const Eigen::VectorXd& weights,
                              const Eigen::MatrixXd& /*numbers*/,
                              const std::function<double(const std::string&)>& constant) {
    std::vector<double> constants;
    for (const std::string& name : definition->constants) constants.push_back(constant(name));
    return std::make_shared<PythonFeature>(definition, stencils, weights, std::move(constants));
  };
  return kind;
}

void Define(const std::string& name, int vertices, int values, bool is_rigid_invariant, bool is_sum,
            const std::vector<std::string>& constants, const py::object& evaluate,
            const py::object& freeze) {
  // A definition that is replaced is deleted after this, when the registry is not locked.
  const auto former = IsRegistered(name) ? internal::FindFeature(name) : internal::FeatureKind();
  internal::Register(name, typeid(PythonFeature),
                     KindOf(Share({name, vertices, values, is_rigid_invariant, is_sum, constants,
                                   evaluate, freeze})));
}

template <typename Value>
void BindVector(py::class_<MetricBasis>* basis, const char* name, Value MetricBasis::*member,
                const char* about) {
  basis->def_property_readonly(
      name, [member](const MetricBasis& self) { return FromMatrix(self.*member); }, about);
}

void BindBasis(py::module_* module) {
  py::class_<MetricBasis> basis(
      *module, "MetricBasis",
      "What a feature's elements and weights are computed from: a mesh and poses of it, in the\n"
      "metric's unit of length. Measures are means over the poses.");
  basis
      .def_property_readonly(
          "faces",
          [](const MetricBasis& self) { return FromMatrix(self.connectivity->Triangles()); },
          "The triangles, m x 3.")
      .def_property_readonly(
          "edges", [](const MetricBasis& self) { return FromMatrix(self.connectivity->Edges()); },
          "The edges, k x 2.")
      .def_property_readonly(
          "hinges", [](const MetricBasis& self) { return FromMatrix(self.connectivity->Hinges()); },
          "The hinges, k x 4: an edge, and the vertices opposite to it.")
      .def_property_readonly(
          "poses", [](const MetricBasis& self) { return FromShapes(self.poses); },
          "The poses, k x n x 3.")
      .def_readonly("unit", &MetricBasis::unit,
                    "The length, in the unit of the poses as they were given, that counts as 1.")
      .def_property_readonly("collapsed_squared", &MetricBasis::CollapsedSquared,
                             "The square of a length far below those of the mesh, with which "
                             "features of collapsed elements remain finite.");
  BindVector(&basis, "triangle_area", &MetricBasis::triangle_area,
             "Of each triangle; the sum is 1.");
  BindVector(&basis, "vertex_area", &MetricBasis::vertex_area,
             "The share of the surface that each vertex stands for.");
  BindVector(&basis, "edge_area", &MetricBasis::edge_area,
             "Of each edge: a third of the triangles at it.");
  BindVector(&basis, "hinge_area", &MetricBasis::hinge_area,
             "Of each hinge: a third of its two triangles.");
  BindVector(&basis, "squared_length", &MetricBasis::squared_length, "Of each edge.");
  BindVector(&basis, "triangle_stiffness", &MetricBasis::triangle_stiffness,
             "Of each triangle the factor on the cost of stretching.");
  BindVector(&basis, "edge_stiffness", &MetricBasis::edge_stiffness,
             "Of each edge the factor on the cost of stretching.");
  BindVector(&basis, "hinge_stiffness", &MetricBasis::hinge_stiffness,
             "Of each hinge the factor on the cost of bending.");
  BindVector(&basis, "edge_bending_stiffness", &MetricBasis::edge_bending_stiffness,
             "Of each edge the same, for curves made of segments.");
}

}  // namespace

void BindFeatures(py::module_* module) {
  BindBasis(module);
  module->def("define_feature", &Define);
  module->attr("_MAX_VERTICES") = int{Feature::kMaxVertices};
  module->attr("_MAX_VALUES") = int{Feature::kMaxValues};
}

}  // namespace shapespace::python
