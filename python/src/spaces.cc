#include <filesystem>
#include <sstream>
#include <utility>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <shapespace/base/error.h>
#include <shapespace/exploration/embedding.h>
#include <shapespace/exploration/explore.h>
#include <shapespace/exploration/space_file.h>
#include <shapespace/exploration/triangulation.h>
#include <shapespace/files/display_names.h>
#include <shapespace/output/picture.h>

#include "arrays.h"
#include "bind.h"
#include "options.h"
#include "pickling.h"
#include "progress.h"
#include "unlocked.h"

namespace shapespace::python {
namespace {

bool IsOnePoint(py::handle points) {
  const py::array array = py::array::ensure(points);
  return array && array.ndim() == 1;
}

// A point of the plane, or several, k x 2.
Eigen::Matrix2Xd ToPoints(py::handle value) {
  const Eigen::MatrixXd points = IsOnePoint(value)
                                     ? Eigen::MatrixXd(ToVector(value, "points"))
                                     : Eigen::MatrixXd(ToMatrix(value, "points").transpose());
  if (points.rows() != 2) throw py::value_error("points: must be k x 2 numbers, x and y of each");
  return points;
}

ExploreOptions FromKeywords(const py::dict& given) {
  ExploreOptions options;
  Set(given, &options);
  options.Validate();
  return options;
}

py::class_<PoseSpace> BindSpace(py::module_* module) {
  return py::class_<PoseSpace>(*module, "Space",
                               R"(Poses of a mesh and shapes between them, on a plane.

Distances on the plane are about the lengths of geodesics. A sequence of nodes, n x 3 each: the
poses, then the shapes found half way between nodes. `explore` makes it.
)")
      .def_static(
          "read",
          [](const std::filesystem::path& file) {
            const Unlocked unlocked;
            return ReadSpace(file);
          },
          py::arg("file"), "Reads a .space file.")
      .def("_write", [](const PoseSpace& space,
                        const std::filesystem::path& file) { WriteSpace(file, space); })
      .def(Pickle<PoseSpace>())
      .def("__len__", &PoseSpace::NumNodes)
      .def("__getitem__",
           [](const PoseSpace& space, py::ssize_t node) {
             return FromShape(space.Placed(PositionIn(node, space.NumNodes(), "node")));
           })
      .def_readonly("names", &PoseSpace::names, "Of the poses.")
      .def_property_readonly(
          "metric", [](const PoseSpace& space) { return FrozenMetric{space.metric}; },
          "Frozen on all poses.")
      .def_property_readonly(
          "faces",
          [](const PoseSpace& space) {
            return FromMatrix(space.metric->connectivity->FileTriangles());
          },
          "The triangles, m x 3.")
      .def_property_readonly(
          "points", [](const PoseSpace& space) { return FromMatrix(space.points); },
          "Each node's place on the plane, k x 2, in the unit of lengths.")
      .def_property_readonly(
          "triangles", [](const PoseSpace& space) { return FromMatrix(space.triangles); },
          "Nodes of the triangles that tile the plane, k x 3.")
      .def_property_readonly(
          "segments", [](const PoseSpace& space) { return FromMatrix(space.segments); },
          "In their place, where all poses lie on a line, k x 2.")
      .def_property_readonly(
          "parents", [](const PoseSpace& space) { return space.parents; },
          "Of each node after the poses the two nodes that it lies half way between.")
      .def_property_readonly(
          "distances", [](const PoseSpace& space) { return FromMatrix(space.distances); },
          "Lengths of the geodesics between every two poses.")
      .def_readonly("stress", &PoseSpace::stress,
                    "How far the plane is from holding all distances.");
}

void BindPlane(py::class_<PoseSpace>* pose_space) {
  pose_space
      ->def(
          "at",
          [](const PoseSpace& space, py::handle points) {
            const Eigen::Matrix2Xd all = ToPoints(points);
            if (IsOnePoint(points)) return FromShape(space.At(all.col(0)));
            std::vector<Shape> shapes;
            for (const auto& point : all.colwise()) shapes.push_back(space.At(point));
            return FromShapes(shapes);
          },
          py::arg("points"),
          "The shape, n x 3, at a point of the plane, or the shapes, k x n x 3, at points, k x 2. "
          "At a point outside of the poses' hull (`contains`) it is the shape at the nearest point "
          "of the hull.")
      .def(
          "contains",
          [](const PoseSpace& space, py::handle points) -> py::object {
            const Eigen::Matrix2Xd all = ToPoints(points);
            if (IsOnePoint(points)) return py::bool_(space.Locate(all.col(0)).inside);
            py::array_t<bool> inside(all.cols());
            for (Eigen::Index i = 0; i < all.cols(); ++i) {
              inside.mutable_data()[i] = space.Locate(all.col(i)).inside;
            }
            return inside;
          },
          py::arg("points"),
          "Whether a point of the plane, or each of points, k x 2, lies in the hull of the poses.")
      .def("_measure_blends",
           [](const PoseSpace& space, int samples, const py::dict& given,
              const py::object& progress) {
             const ExploreOptions options = FromKeywords(given);
             const BlendErrors errors = WithoutLock(progress, [=](Progress* told) {
               return MeasureBlends(space, samples, options, told);
             });
             return py::make_tuple(errors.mean, errors.max, errors.within);
           })
      .def("_read_curve",
           [](const PoseSpace& space, const std::filesystem::path& file) {
             const std::vector<Eigen::Vector2d> curve = ReadCurve(file, space);
             Eigen::Matrix2Xd points(2, curve.size());
             for (size_t i = 0; i < curve.size(); ++i) points.col(i) = curve[i];
             return FromMatrix(points);
           })
      .def(
          "along",
          [](const PoseSpace& space, py::handle points, int frames) {
            const Eigen::Matrix2Xd all = ToPoints(points);
            const std::vector<Eigen::Vector2d> polyline(all.colwise().begin(), all.colwise().end());
            PlaneWalk walk = WithoutLock(
                py::none(), [=](Progress*) { return WalkAlong(space, polyline, frames); });
            if (walk.outside > 0) {
              Warn({std::to_string(walk.outside) + " of the " + std::to_string(frames) +
                    " points lie outside of the poses' hull and were replaced by the nearest "
                    "points of the hull"});
            }
            return std::move(walk.path);
          },
          py::arg("points"), py::arg("frames"),
          "The shapes along a polyline of the plane, k x 2, as a path of so many. Points outside "
          "of the poses' hull are replaced by the nearest points of the hull, with a warning.")
      .def("_repr_html_",
           [](const PoseSpace& space) {
             FilmStripOptions options;
             std::vector<Shape> poses;
             for (int i = 0; i < space.NumPoses(); ++i) {
               poses.push_back(space.Placed(i));
               options.labels.push_back(std::to_string(i));
             }
             const auto connectivity = space.metric->connectivity;
             return py::cast(Draw(connectivity, poses, options)).attr("_repr_html_")();
           })
      .def("__repr__", [](const PoseSpace& space) {
        return "<shapespace.Space: " + std::to_string(space.NumPoses()) + " poses, " +
               std::to_string(space.NumNodes()) + " nodes>";
      });
}

}  // namespace

void BindSpaces(py::module_* module) {
  auto pose_space = BindSpace(module);
  BindPlane(&pose_space);
  module->def("embed", [](py::handle distances, const py::dict& given) {
    EmbeddingOptions options;
    Set(given, &options);
    const Embedding found = Embed(ToMatrix(distances, "distances"), options);
    return py::make_tuple(FromMatrix(found.points), found.stress, found.converged);
  });
  module->def("triangulate", [](py::handle points) {
    return FromMatrix(DelaunayTriangulation(ToPoints(points)).triangles);
  });
  module->def("distance_matrix",
              [](const Poses& poses, const py::dict& given, const py::object& progress) {
                const ExploreOptions options = FromKeywords(given);
                return FromMatrix(WithoutLock(progress, [=](Progress* told) {
                  return DistanceMatrix(poses.connectivity, poses.shapes, options, told);
                }));
              });
  module->def("explore", [](const Poses& poses, const std::vector<std::string>& names,
                            const py::dict& given, const py::object& progress) {
    const ExploreOptions options = FromKeywords(given);
    ExploreResult result = WithoutLock(progress, [=](Progress* told) {
      return Explore(poses.connectivity, poses.shapes,
                     names.empty() ? DisplayNames(poses.names) : names, options, told);
    });
    result.space.appearance = poses.soup.appearance;
    result.space.provenance = "shapespace " SHAPESPACE_VERSION " for Python: explore";
    return py::make_tuple(std::move(result.space), std::move(result.summary));
  });
}

}  // namespace shapespace::python
