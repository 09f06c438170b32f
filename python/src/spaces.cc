#include <filesystem>
#include <sstream>
#include <utility>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <shapespace/base/error.h>
#include <shapespace/exploration/explore.h>
#include <shapespace/exploration/space_file.h>
#include <shapespace/files/display_names.h>
#include <shapespace/output/picture.h>

#include "arrays.h"
#include "bind.h"
#include "options.h"
#include "progress.h"

namespace shapespace::python {
namespace {

Eigen::Vector2d ToPoint(py::handle value, const std::string& name) {
  const Eigen::VectorXd point = ToVector(value, name);
  if (point.size() != 2) throw py::value_error(name + ": must be two numbers, x and y");
  return point;
}

ExploreOptions FromKeywords(const py::dict& given) {
  ExploreOptions options;
  Set(given, &options);
  options.Validate();
  return options;
}

void BindSpace(py::module_* module) {
  py::class_<PoseSpace>(*module, "Space", R"(Poses of a mesh and shapes between them, on a plane.

Distances on the plane are about the lengths of geodesics. A sequence of nodes, n x 3 each: the
poses, then the shapes found half way between nodes. `explore` makes it.
)")
      .def_static(
          "read",
          [](const std::filesystem::path& file) {
            const py::gil_scoped_release unlocked;
            return ReadSpace(file);
          },
          py::arg("file"), "Reads a .space file.")
      .def(
          "write",
          [](const PoseSpace& space, const std::filesystem::path& file) {
            WriteSpace(file, space);
          },
          py::arg("file"), "Writes a .space file.")
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
            return FromMatrix(space.metric->connectivity->Triangles());
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
                    "How far the plane is from holding all distances.")
      .def(
          "at",
          [](const PoseSpace& space, py::handle point) {
            return FromShape(space.At(ToPoint(point, "point")));
          },
          py::arg("point"),
          "The shape, n x 3, at a point of the plane. At a point outside of the poses' hull "
          "(`contains`) it is the shape at the nearest point of the hull.")
      .def(
          "contains",
          [](const PoseSpace& space, py::handle point) {
            return space.Locate(ToPoint(point, "point")).inside;
          },
          py::arg("point"), "Whether a point of the plane lies in the hull of the poses.")
      .def(
          "along",
          [](const PoseSpace& space, py::handle points, int frames) {
            std::vector<Eigen::Vector2d> polyline;
            for (py::handle point : points) polyline.push_back(ToPoint(point, "points"));
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
  BindSpace(module);
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
