#include <filesystem>
#include <utility>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <shapespace/base/error.h>
#include <shapespace/correspondence/correspondence.h>
#include <shapespace/correspondence/correspondence_picture.h>
#include <shapespace/correspondence/landmark_file.h>
#include <shapespace/correspondence/marker_file.h>

#include "arrays.h"
#include "bind.h"
#include "options.h"
#include "progress.h"

namespace shapespace::python {
namespace {

std::vector<CorrespondenceMarker> ToMarkers(py::handle value, const Poses& source,
                                            const Poses& target) {
  std::vector<CorrespondenceMarker> markers;
  if (value.is_none()) return markers;
  for (const auto& [first, second] : ToPairs(value, "markers", source.connectivity->NumVertices(),
                                             target.connectivity->NumVertices())) {
    markers.push_back({first, second});
  }
  return markers;
}

py::object PairsOf(const std::vector<CorrespondenceMarker>& markers) {
  Eigen::Matrix2Xi pairs(2, markers.size());
  for (size_t i = 0; i < markers.size(); ++i) {
    pairs.col(i) << markers[i].template_vertex, markers[i].target_vertex;
  }
  return FromMatrix(pairs);
}

void BindSurfaceMap(py::module_* module) {
  py::class_<SurfacePoints>(*module, "SurfacePoints",
                            "Where each vertex of one mesh lies on the surface of another.")
      .def_property_readonly(
          "triangle", [](const SurfacePoints& points) { return FromMatrix(points.triangle); },
          "Of each vertex the triangle, counted from 0, of the other mesh's `faces`.")
      .def_property_readonly(
          "barycentric", [](const SurfacePoints& points) { return FromMatrix(points.barycentric); },
          "Of each vertex the weights, n x 3, of that triangle's corners.")
      .def("__len__", &SurfacePoints::NumVertices)
      .def(py::pickle(
          [](const SurfacePoints& points) {
            return py::make_tuple(FromMatrix(points.triangle), FromMatrix(points.barycentric));
          },
          [](const py::tuple& state) {
            return SurfacePoints{ToVector(state[0], "triangle").cast<int>(),
                                 ToShape(state[1], "barycentric")};
          }))
      .def("_pull", [](const SurfacePoints& points, const Poses& mesh, py::handle values) {
        const auto array = Contiguous<double>(values);
        if (array.ndim() != 2) throw py::value_error("values: must be n or n x d numbers");
        if (array.shape(0) != mesh.connectivity->NumVertices()) {
          throw MeshError("values: has " + std::to_string(array.shape(0)) +
                          " rows, but the mesh has " +
                          std::to_string(mesh.connectivity->NumVertices()) + " vertices");
        }
        const Eigen::Map<const Eigen::MatrixXd> function(array.data(), array.shape(1),
                                                         array.shape(0));
        return FromMatrix(PullBack(points, mesh.connectivity->Triangles(), function));
      });
  py::class_<SurfaceMap>(*module, "SurfaceMap",
                         "A map between the surfaces of two meshes of different connectivity.")
      .def_readonly("to_target", &SurfaceMap::to_target,
                    "Of each vertex of the template its place on the target.")
      .def_readonly("to_template", &SurfaceMap::to_template,
                    "Of each vertex of the target its place on the template.")
      .def_property_readonly(
          "round_trip", [](const SurfaceMap& map) { return FromMatrix(map.round_trip); },
          "Of each vertex of the template how far from itself it comes back, as a share of the "
          "root "
          "of the area.")
      .def_property_readonly(
          "gap", [](const SurfaceMap& map) { return FromMatrix(map.gap); },
          "Of each vertex of the target how far the fitted template is from it, likewise.")
      .def(py::pickle(
          [](const SurfaceMap& map) {
            return py::make_tuple(map.to_target, map.to_template, FromMatrix(map.round_trip),
                                  FromMatrix(map.gap));
          },
          [](const py::tuple& state) {
            return SurfaceMap{py::cast<SurfacePoints>(state[0]), py::cast<SurfacePoints>(state[1]),
                              ToVector(state[2], "round_trip"), ToVector(state[3], "gap")};
          }))
      .def(
          "write",
          [](const SurfaceMap& map, const std::filesystem::path& file) {
            WriteSurfaceMap(file, map);
          },
          py::arg("file"), "Writes the map as text.")
      .def_static("_read",
                  [](const std::filesystem::path& file, const Poses& source, const Poses& target) {
                    return ReadSurfaceMap(file, source.connectivity->NumTriangles(),
                                          target.connectivity->NumTriangles());
                  });
}

}  // namespace

void BindCorrespondence(py::module_* module) {
  BindSurfaceMap(module);
  py::class_<CorrespondenceResult>(*module, "_Correspondence")
      .def_property_readonly(
          "fitted", [](const CorrespondenceResult& result) { return FromShape(result.fitted); })
      .def(py::pickle(
          [](const CorrespondenceResult& result) {
            return py::make_tuple(FromShape(result.fitted), result.map, result.summary,
                                  PairsOf(result.markers), result.in_doubt);
          },
          [](const py::tuple& state) {
            CorrespondenceResult result{ToShape(state[0], "fitted"),
                                        py::cast<SurfaceMap>(state[1]),
                                        py::cast<CorrespondenceSummary>(state[2]),
                                        {},
                                        py::cast<std::vector<int>>(state[4])};
            for (const py::handle pair : state[3]) {
              const auto ends = py::cast<std::pair<int, int>>(pair);
              result.markers.push_back({ends.first, ends.second});
            }
            return result;
          }))
      .def_property_readonly(
          "markers", [](const CorrespondenceResult& result) { return PairsOf(result.markers); })
      .def_readonly("map", &CorrespondenceResult::map)
      .def_readonly("summary", &CorrespondenceResult::summary)
      .def("carry",
           [](const CorrespondenceResult& result, const Path& path, const Poses& target) {
             Path carried = WithoutLock(py::none(), [=](Progress*) {
               return CarryPath(result, path, target.connectivity, target.shapes[0]);
             });
             carried.appearance = target.soup.appearance;
             return carried;
           })
      .def("picture", [](const CorrespondenceResult& result, const Poses& source,
                         const Poses& target, py::handle markers) {
        const std::vector<CorrespondenceMarker> pairs = ToMarkers(markers, source, target);
        return WithoutLock(py::none(), [=](Progress*) {
          return RenderCorrespondence(*source.connectivity, source.shapes[0], *target.connectivity,
                                      target.shapes[0], pairs, result);
        });
      });
  module->def("correspond", [](const Poses& source, const Poses& target, py::handle markers,
                               const py::dict& given, const py::object& progress) {
    const std::vector<CorrespondenceMarker> pairs = ToMarkers(markers, source, target);
    CorrespondenceOptions options;
    Set(given, &options);
    options.Validate();
    return WithoutLock(progress, [=](Progress* told) {
      return Correspond(source.connectivity, source.shapes[0], target.connectivity,
                        target.shapes[0], pairs, options, told);
    });
  });
  module->def("match_landmarks", [](const std::string& file, const std::string& other,
                                    const Poses& source, const Poses& target) {
    const MatchedLandmarks matched = MatchLandmarks(file, other, source, target);
    Warn(matched.warnings);
    return PairsOf(matched.markers);
  });
  module->def("read_markers",
              [](const std::string& file, const Poses& source, const Poses& target) {
                return PairsOf(ReadMarkers(file, source, target));
              });
}

}  // namespace shapespace::python
