#include <sstream>

#include <shapespace/analysis/shape_error.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/path/energy.h>

#include "arrays.h"
#include "bind.h"
#include "options.h"
#include "pickling.h"
#include "progress.h"
#include "unlocked.h"

namespace shapespace::python {
namespace {

// At a shape of the user's unit, for tangents of the metric's.
FeatureDerivative DerivativeAt(const FrozenMetric& self, const Shape& shape) {
  return FeatureMap(self.metric).Derivative(shape / self.metric->unit);
}

// Both triangles of the metric's matrix, for tangents of shapes in the user's unit: data, row of
// each, where columns begin.
py::tuple FullMatrix(const FrozenMetric& self, const Shape& shape) {
  const auto full = WithoutLock(py::none(), [=](Progress*) {
    const double unit = self.metric->unit;
    const Eigen::SparseMatrix<double> lower = DerivativeAt(self, shape).MetricMatrix();
    Eigen::SparseMatrix<double> both = lower.selfadjointView<Eigen::Lower>();
    both /= unit * unit;
    both.makeCompressed();
    return both;
  });
  const Eigen::Map<const Eigen::VectorXd> values(full.valuePtr(), full.nonZeros());
  const Eigen::Map<const Eigen::VectorXi> rows(full.innerIndexPtr(), full.nonZeros());
  const Eigen::Map<const Eigen::VectorXi> begin(full.outerIndexPtr(), full.cols() + 1);
  return py::make_tuple(FromMatrix(values), FromMatrix(rows), FromMatrix(begin));
}

py::class_<FrozenMetric> BindMetric(py::module_* module) {
  return py::class_<FrozenMetric>(*module, "Metric")
      .def(py::init([](py::handle poses, py::handle faces, const py::object& preset,
                       const py::object& pairs, const py::kwargs& given) {
             MetricOptions options;
             Value<MetricOptions>::Set(&options, preset, "preset");
             Set(given, &options);
             PosePairs which = PosePairs::kConsecutive;
             Value<PosePairs>::Set(&which, pairs, "pairs");
             Poses mesh;
             if (py::isinstance<Poses>(poses)) {
               if (!faces.is_none()) {
                 throw py::type_error("faces: leave them out, since the poses have a mesh already");
               }
               mesh = py::cast<const Poses&>(poses);
             } else {
               mesh = MakePoses(ToShapes(poses, "poses"), faces);
               Warn(mesh.warnings);
             }
             const Unlocked unlocked;
             return FrozenMetric{FreezeMetric(options, mesh.connectivity, mesh.shapes, 0, which)};
           }),
           py::arg("poses"), py::arg("faces") = py::none(), py::kw_only(),
           py::arg("preset") = "strain", py::arg("pairs") = "consecutive")
      .def(Pickle<FrozenMetric>())
      .def_property_readonly(
          "unit", [](const FrozenMetric& self) { return self.metric->unit; },
          "The length, in the unit of the poses, that counts as 1.")
      .def_property_readonly(
          "options", [](const FrozenMetric& self) { return Get(self.metric->options); },
          "The options that it was made with, as a dict.")
      .def_property_readonly(
          "faces",
          [](const FrozenMetric& self) {
            return FromMatrix(self.metric->connectivity->FileTriangles());
          },
          "The triangles, m x 3.")
      .def_property_readonly(
          "edges",
          [](const FrozenMetric& self) { return FromMatrix(self.metric->connectivity->Edges()); },
          "The edges, k x 2.")
      .def_property_readonly(
          "hinges",
          [](const FrozenMetric& self) { return FromMatrix(self.metric->connectivity->Hinges()); },
          "The hinges, k x 4: an edge, and the vertices opposite to it.")
      .def_property_readonly(
          "vertex_area",
          [](const FrozenMetric& self) { return FromMatrix(self.metric->vertex_area); },
          "The share of the surface that each vertex stands for.")
      .def_property_readonly(
          "edge_area", [](const FrozenMetric& self) { return FromMatrix(self.metric->edge_area); },
          "Of each edge: a third of the triangles at it; the surface's area is 1.")
      .def_property_readonly(
          "hinge_area",
          [](const FrozenMetric& self) { return FromMatrix(self.metric->hinge_area); },
          "Of each hinge: a third of its two triangles.");
}

void BindMeasures(py::class_<FrozenMetric>* metric) {
  metric
      ->def(
          "norm",
          [](const FrozenMetric& self, py::handle shape, py::handle tangent) {
            const int n = self.metric->connectivity->NumVertices();
            const Shape p = ToShape(shape, "shape", n), x = ToShape(tangent, "tangent", n);
            return WithoutLock(py::none(), [=](Progress*) {
              return DerivativeAt(self, p).Times(x / self.metric->unit).norm();
            });
          },
          py::arg("shape"), py::arg("tangent"), R"(Length of a tangent at a shape: a pure number.

Parameters
----------
shape, tangent : array_like
    n x 3, in the unit of the poses.

Raises
------
InvalidOptions
    The metric has a rigid part.
)")
      .def(
          "inner",
          [](const FrozenMetric& self, py::handle shape, py::handle first, py::handle second) {
            const int n = self.metric->connectivity->NumVertices();
            const Shape p = ToShape(shape, "shape", n);
            const Shape x = ToShape(first, "first", n), y = ToShape(second, "second", n);
            return WithoutLock(py::none(), [=](Progress*) {
              const double unit = self.metric->unit;
              const FeatureDerivative derivative = DerivativeAt(self, p);
              return derivative.Times(x / unit).dot(derivative.Times(y / unit));
            });
          },
          py::arg("shape"), py::arg("first"), py::arg("second"),
          R"(Inner product of two tangents at a shape: a pure number.

Parameters
----------
shape, first, second : array_like
    n x 3, in the unit of the poses.

Raises
------
InvalidOptions
    The metric has a rigid part.
)")
      .def(
          "energy_lower_bound",
          [](const FrozenMetric& self, py::handle first, py::handle last, int segments) {
            const int n = self.metric->connectivity->NumVertices();
            const Shape p = ToShape(first, "first", n), q = ToShape(last, "last", n);
            if (segments < 1) throw py::value_error("segments: must be at least 1");
            return WithoutLock(py::none(), [=](Progress*) {
              const std::vector<Shape> ends = MakePath(self.metric, {p, q}).shapes;  // aligned
              return ScaledEnergy(EnergyLowerBound(*self.metric, ends[0], ends[1], segments),
                                  segments);
            });
          },
          py::arg("first"), py::arg("last"), py::arg("segments") = 1,
          R"(What no path between two shapes has less energy than.

Parameters
----------
first, last : array_like
    n x 3, in the unit of the poses.
segments : int, optional
    Of the path; the bound is that of `GeodesicSummary.lower_bound`.

Returns
-------
float
    In the unit of `GeodesicSummary.energy`.
)")
      .def("_matrix",
           [](const FrozenMetric& self, py::handle shape) {
             return FullMatrix(self,
                               ToShape(shape, "shape", self.metric->connectivity->NumVertices()));
           })
      .def("__repr__", [](const FrozenMetric& self) {
        std::ostringstream text;
        text << "<shapespace.Metric: " << DescribeMetric(self.metric->options) << "; unit "
             << self.metric->unit << ", " << self.metric->connectivity->NumVertices()
             << " vertices>";
        return text.str();
      });
}

}  // namespace

void BindMetrics(py::module_* module) {
  auto metric = BindMetric(module);
  BindMeasures(&metric);
  module->def("compare_shapes",
              [](const FrozenMetric& metric, py::handle reference, py::handle shape) {
                const int n = metric.metric->connectivity->NumVertices();
                return CompareShapes(metric.metric, ToPose(reference, "reference", n),
                                     ToPose(shape, "shape", n));
              });
}

}  // namespace shapespace::python
