#include <utility>

#include <pybind11/stl.h>

#include <shapespace/analysis/intersections.h>
#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/bodies/body.h>
#include <shapespace/bodies/skinned.h>
#include <shapespace/exploration/space.h>
#include <shapespace/files/pose_order.h>
#include <shapespace/files/vertex_field.h>
#include <shapespace/files/write.h>
#include <shapespace/mesh/check.h>
#include <shapespace/mesh/different_meshes.h>
#include <shapespace/mesh/selection.h>
#include <shapespace/output/frames.h>

#include "arrays.h"
#include "bind.h"
#include "pickling.h"
#include "progress.h"

namespace shapespace::python {
namespace {

// As the user wrote it.
std::string NameOfShape(const ArgumentNames& names, size_t i) {
  return names.shapes.empty() ? NumberedName("shapes", i) : names.shapes[i];
}

// A mesh whose connectivity is there already.
Poses PosesOf(const std::shared_ptr<const Connectivity>& connectivity, Soup soup,
              std::vector<Shape> shapes, const ArgumentNames& names) {
  for (size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i].cols() == connectivity->NumVertices()) continue;
    throw MeshError(internal::OfOtherMesh(NameOfShape(names, i), shapes[i].cols(),
                                          connectivity->NumVertices(), kCorrespond));
  }
  Poses poses;
  poses.connectivity = connectivity;
  poses.soup = std::move(soup);
  if (!shapes.empty()) poses.soup.vertices = shapes[0];
  poses.shapes = std::move(shapes);
  return poses;
}

std::shared_ptr<const Connectivity> ConnectivityIn(py::handle mesh, Appearance* appearance) {
  if (py::isinstance<FrozenMetric>(mesh)) {
    return py::cast<const FrozenMetric&>(mesh).metric->connectivity;
  }
  if (py::isinstance<Path>(mesh)) {
    const auto& path = py::cast<const Path&>(mesh);
    *appearance = path.appearance;
    return path.metric->connectivity;
  }
  if (py::isinstance<PoseSpace>(mesh)) {
    const auto& space = py::cast<const PoseSpace&>(mesh);
    *appearance = space.appearance;
    return space.metric->connectivity;
  }
  if (py::isinstance<ShapeFamily>(mesh)) return py::cast<const ShapeFamily&>(mesh).connectivity;
  if (py::isinstance<SkinnedBody>(mesh)) return py::cast<const SkinnedBody&>(mesh).connectivity;
  return nullptr;
}

ReadOptions ReadingOptions(bool allow_nonmanifold, bool open_seams, const py::object& mirror,
                           bool allow_mirrored, bool allow_mismatch, bool loose_components) {
  ReadOptions options;
  options.allow_mirrored = allow_mirrored;
  options.allow_mismatch = allow_mismatch;
  options.loose_components = loose_components;
  options.allow_nonmanifold = allow_nonmanifold;
  options.open_seams = open_seams;
  if (!mirror.is_none()) {
    const auto axis = py::cast<std::string>(mirror);
    if (axis != "x" && axis != "y" && axis != "z") {
      throw py::value_error("mirror: must be 'x', 'y', 'z' or None, not '" + axis + "'");
    }
    options.mirror = axis[0];
  }
  return options;
}

// For meshes of which no solver uses the edges.
ReadOptions Loose() {
  ReadOptions options;
  options.loose_components = true;
  return options;
}

py::list Polygons(const Connectivity& connectivity) {
  py::list polygons;
  const std::vector<int>& begin = connectivity.PolygonBegin();
  for (int i = 0; i < connectivity.NumPolygons(); ++i) {
    py::list polygon;
    for (int k = begin[i]; k < begin[i + 1]; ++k) polygon.append(connectivity.Corners()[k]);
    polygons.append(polygon);
  }
  return polygons;
}

py::class_<Poses> BindPoses(py::module_* module) {
  return py::class_<Poses>(*module, "Poses",
                           R"(Poses of one mesh: what `read` returns and solvers take.

A sequence of the poses' vertices, n x 3 each.

Parameters
----------
shapes : sequence of array_like
    The vertices of each pose, n x 3, in any unit: any type of integer or float, in any order of
    memory.
faces : array_like, or an object with a mesh
    The polygons that all poses share: m x 3 integers counted from 0, or a list of polygons of any
    numbers of corners. A `Poses`, `Path`, `Metric`, `Space` or body stands for its own. None, of a
    graph, which has segments only.
segments : array_like, optional
    Edges of a straight-line graph, k x 2.
stiffeners : array_like, optional
    Further edges that the metric is to hold, k x 2.
allow_nonmanifold : bool, optional
    Take non-manifold or inconsistently wound meshes, with a warning.
open_seams : bool, optional
    Leave the surface open where borders lie on each other in all poses, as lips do that never part.
    By default their vertices are one point of the surface, and have the same position in all
    results.
mirror : {'x', 'y', 'z'}, optional
    Poses that are mirror images of the first have this coordinate's sign changed. Without it they
    are refused.
allow_mirrored : bool, optional
    Take poses that look like mirror images of the first as they are, with a warning: domes that are
    pushed through, bodies that are turned inside out.
allow_mismatch : bool, optional
    Take poses as they are, with a warning, whose units or order of vertices seem to be others than
    those of the first.
loose_components : bool, optional
    Leave connected components loose, such as eyes and clothes, that stay near others in all poses.
    Otherwise they are tied to these by stiffeners, and `notes` says how many.

Raises
------
MeshError
    The mesh cannot serve: an index out of range, a vertex that is not finite.
MismatchError
    The shapes are no poses of one mesh.
)")
      .def(py::init([](py::handle shapes, py::handle faces, py::handle segments,
                       py::handle stiffeners, bool allow_nonmanifold, bool open_seams,
                       const py::object& mirror, bool allow_mirrored, bool allow_mismatch,
                       bool loose_components) {
             Poses poses =
                 MakePoses(ToShapes(shapes, "shapes"), faces,
                           ReadingOptions(allow_nonmanifold, open_seams, mirror, allow_mirrored,
                                          allow_mismatch, loose_components),
                           segments, stiffeners);
             Warn(poses.warnings);
             return poses;
           }),
           py::arg("shapes"), py::arg("faces") = py::none(), py::kw_only(),
           py::arg("segments") = py::none(), py::arg("stiffeners") = py::none(),
           py::arg("allow_nonmanifold") = ReadOptions().allow_nonmanifold,
           py::arg("open_seams") = ReadOptions().open_seams, py::arg("mirror") = py::none(),
           py::arg("allow_mirrored") = ReadOptions().allow_mirrored,
           py::arg("allow_mismatch") = ReadOptions().allow_mismatch,
           py::arg("loose_components") = ReadOptions().loose_components)
      .def(Pickle<Poses>());
}

void BindContent(py::class_<Poses>* poses_class) {
  poses_class->def("__len__", [](const Poses& poses) { return poses.shapes.size(); })
      .def("__getitem__",
           [](const Poses& poses, py::ssize_t i) {
             return FromShape(
                 poses.shapes[PositionIn(i, static_cast<int>(poses.shapes.size()), "pose")]);
           })
      .def("__getitem__",
           [](const Poses& poses, const py::slice& which) {
             return py::object(FromShapes(poses.shapes)[which]);
           })
      .def_property_readonly(
          "vertices", [](const Poses& poses) { return FromShapes(poses.shapes); },
          "The vertices of all poses, k x n x 3: a copy.")
      .def_property_readonly(
          "faces",
          [](const Poses& poses) { return FromMatrix(poses.connectivity->FileTriangles()); },
          "The triangles, m x 3, into which the polygons are cut.")
      .def_property_readonly(
          "polygons", [](const Poses& poses) { return Polygons(*poses.connectivity); },
          "The polygons as they were given: a list of lists.")
      .def_property_readonly(
          "edges", [](const Poses& poses) { return FromMatrix(poses.connectivity->Edges()); },
          "The edges, k x 2, each once.")
      .def_readonly("names", &Poses::names, "The files that the poses were read from.")
      .def_readonly("warnings", &Poses::warnings, "What is worth a look.")
      .def_readonly("notes", &Poses::notes, "What was done with the mesh that is right as a rule.")
      .def_property_readonly(
          "dropped", [](const Poses& poses) { return poses.soup.dropped; },
          "What the first file holds and is not kept.")
      .def("__repr__", [](const Poses& poses) {
        const Connectivity& mesh = *poses.connectivity;
        return "<shapespace.Poses: " + std::to_string(poses.shapes.size()) + " of " +
               std::to_string(mesh.NumVertices()) + " vertices, " +
               std::to_string(mesh.NumTriangles()) + " triangles>";
      });
}

// Poses and meshes of arrays, whose arguments messages call as `name` has it.
void BindMaking(py::module_* module) {
  module->def("make_poses", [](py::handle shapes, py::handle faces, const std::string& name) {
    std::vector<Shape> all = ToShapes(shapes, name);
    ArgumentNames names;
    for (size_t i = 0; i < all.size(); ++i) names.shapes.push_back(NumberedName(name, i));
    Poses poses = MakePoses(std::move(all), faces, {}, py::none(), py::none(), names);
    Warn(poses.warnings);
    return poses;
  });
  module->def("make_mesh", [](py::handle vertices, py::handle faces, const std::string& name,
                              const std::string& name_of_faces) {
    Poses mesh = MakePoses({ToShape(vertices, name)}, faces, {}, py::none(), py::none(),
                           {{name}, name_of_faces});
    Warn(mesh.warnings);
    return mesh;
  });
}

void BindMeshFiles(py::module_* module) {
  module->def(
      "read",
      [](const std::vector<std::string>& files, const std::string& stiffeners,
         bool allow_nonmanifold, bool open_seams, const py::object& mirror, bool allow_mirrored,
         bool allow_mismatch, bool loose_components, bool allow_outside_files) {
        ReadOptions options = ReadingOptions(allow_nonmanifold, open_seams, mirror, allow_mirrored,
                                             allow_mismatch, loose_components);
        options.stiffeners = stiffeners;
        options.allow_outside_files = allow_outside_files;
        Poses poses = WithoutLock(py::none(), [=](Progress*) { return ReadPoses(files, options); });
        const std::string order = OrderWarning(files);
        if (!order.empty()) poses.warnings.push_back(order);
        Warn(poses.warnings);
        return poses;
      },
      py::arg("files"), py::arg("stiffeners"), py::arg("allow_nonmanifold"), py::arg("open_seams"),
      py::arg("mirror"), py::arg("allow_mirrored"), py::arg("allow_mismatch"),
      py::arg("loose_components"), py::arg("allow_outside_files"));

  module->def("write", [](const std::string& file, py::handle vertices, py::handle faces) {
    const Shape shape = ToShape(vertices, "vertices");
    const Poses poses = MakePoses({shape}, faces, Loose());
    WriteMesh(file, shape, poses.soup);
    return NotKept(file, poses.soup);
  });

  module->def("read_vertex_field",
              [](const std::string& source) { return FromMatrix(ReadVertexField(source)); });
}

void BindMeshQueries(py::module_* module) {
  module->def("select", [](const Poses& mesh, const std::string& selection) {
    const std::vector<int> found = SelectVertices(ReadSelection(selection), mesh.shapes[0],
                                                  *mesh.connectivity, mesh.soup.appearance);
    return py::array_t<int>(static_cast<py::ssize_t>(found.size()), found.data());
  });

  module->def("intersections", [](const Poses& poses) {
    const std::vector<std::int64_t> found = WithoutLock(py::none(), [=](Progress*) {
      return CountIntersections(*poses.connectivity, poses.shapes);
    });
    return py::array_t<std::int64_t>(static_cast<py::ssize_t>(found.size()), found.data());
  });

  module->def("check", [](py::handle vertices, py::handle faces) {
    Soup soup;
    soup.vertices = ToShape(vertices, "vertices");
    SetPolygons(faces, &soup);
    py::list findings;
    for (const Finding& finding : CheckSoup(soup)) {
      static const char* const names[] = {"note", "warning", "non-manifold", "mirrored", "fatal"};
      findings.append(
          py::make_tuple(names[static_cast<int>(finding.severity)], finding.kind, finding.message));
    }
    return findings;
  });
}

void BindBodies(py::module_* module) {
  py::class_<ShapeFamily>(*module, "Body", "A body made in code, in poses along one parameter.")
      .def_readonly("name", &ShapeFamily::name)
      .def_readonly("begin", &ShapeFamily::begin, "The parameter's value at rest.")
      .def_readonly("end", &ShapeFamily::end, "The parameter's last value.")
      .def_readonly("parameter", &ShapeFamily::parameter, "What the parameter is, with its unit.")
      .def_property_readonly(
          "faces",
          [](const ShapeFamily& body) { return FromMatrix(body.connectivity->Triangles()); },
          "The triangles, m x 3.")
      .def(
          "pose", [](const ShapeFamily& body, double value) { return FromShape(body.pose(value)); },
          py::arg("value"), "The vertices, n x 3, at a value of the parameter.")
      .def("__repr__", [](const ShapeFamily& body) {
        return "<shapespace.Body: " + body.name + ", " +
               std::to_string(body.connectivity->NumVertices()) + " vertices, " + body.parameter +
               ">";
      });
  py::class_<SkinnedBody>(*module, "SkinnedBody",
                          "A body made in code that has bones, in poses that have names.")
      .def_readonly("name", &SkinnedBody::name)
      .def_readonly("pose_names", &SkinnedBody::pose_names, "The poses; the first is at rest.")
      .def_property_readonly(
          "faces",
          [](const SkinnedBody& body) { return FromMatrix(body.connectivity->Triangles()); },
          "The triangles, m x 3.")
      .def(
          "pose",
          [](const SkinnedBody& body, const std::string& name) {
            return FromShape(body.pose(name));
          },
          py::arg("name"), "The vertices, n x 3, of a pose.")
      .def("__repr__", [](const SkinnedBody& body) {
        return "<shapespace.SkinnedBody: " + body.name + ", " +
               std::to_string(body.connectivity->NumVertices()) + " vertices>";
      });
  module->def("body",
              [](const std::string& name, int triangles) { return MakeBody(name, triangles); });
  module->def(
      "skinned_body", [](const std::string& name, int triangles, const std::string& proportions) {
        return WithoutLock(
            py::none(), [=](Progress*) { return MakeSkinnedBody(name, triangles, proportions); });
      });
}

}  // namespace

Poses MakePoses(std::vector<Shape> shapes, py::handle faces, const ReadOptions& options,
                py::handle segments, py::handle stiffeners, const ArgumentNames& names) {
  if (py::isinstance<Poses>(faces)) {
    const auto& mesh = py::cast<const Poses&>(faces);
    return PosesOf(mesh.connectivity, mesh.soup, std::move(shapes), names);
  }
  Appearance appearance;
  if (const auto connectivity = ConnectivityIn(faces, &appearance)) {
    return PosesOf(connectivity, FrameSoup(*connectivity, appearance), std::move(shapes), names);
  }
  if (faces.is_none() && segments.is_none()) {
    throw py::type_error(names.faces +
                         ": are missing; give m x 3 integers, or an object that has a mesh");
  }
  std::vector<Soup> soups(shapes.size());
  for (size_t i = 0; i < shapes.size(); ++i) {
    soups[i].file = NameOfShape(names, i);  // what messages name
    soups[i].vertices = std::move(shapes[i]);
    if (i == 0) {
      const int num_vertices = soups[0].NumVertices();
      if (!faces.is_none()) SetPolygons(faces, &soups[0], names.faces);
      if (!segments.is_none()) {
        soups[0].segments = ToPairs(segments, "segments", num_vertices, num_vertices);
      }
    } else {
      soups[i].polygon_begin = soups[0].polygon_begin;
      soups[i].corners = soups[0].corners;
      soups[i].segments = soups[0].segments;
    }
  }
  ReadOptions first = options;  // before stiffeners connect what need not be tied
  first.loose_components = options.loose_components || !stiffeners.is_none();
  Poses poses = shapespace::MakePoses(std::move(soups), first);
  if (!stiffeners.is_none()) {
    const int num_vertices = poses.connectivity->NumVertices();
    poses.connectivity = ConnectivityOf(
        poses.soup, poses.shapes, ToPairs(stiffeners, "stiffeners", num_vertices, num_vertices),
        poses.connectivity->Representatives());
    if (!options.loose_components) TieComponents(&poses);
  }
  poses.names.clear();
  poses.soup.file.clear();
  return poses;
}

void CheckIsOfMesh(const Metric& metric, const Connectivity& mesh) {
  const Connectivity& own = *metric.connectivity;
  if (&own == &mesh) return;
  const auto refuse = [](const std::string& difference) {
    throw MeshError("metric: was frozen on another mesh than that of the poses: " + difference +
                    "; freeze a metric on these poses, or name its options");
  };
  const auto compare = [&](const char* what, size_t metrics, size_t poses) {
    if (metrics == poses) return;
    refuse("the metric has " + std::to_string(metrics) + " " + what + ", the poses have " +
           std::to_string(poses));
  };
  compare("vertices", own.NumVertices(), mesh.NumVertices());
  compare("faces", own.NumPolygons(), mesh.NumPolygons());
  compare("segments", own.Segments().size(), mesh.Segments().size());
  for (int p = 0; p < own.NumPolygons(); ++p) {
    const auto corners = [p](const Connectivity& connectivity) {
      const auto begin = connectivity.Corners().begin();
      return std::vector<int>(begin + connectivity.PolygonBegin()[p],
                              begin + connectivity.PolygonBegin()[p + 1]);
    };
    if (corners(own) != corners(mesh)) {
      refuse("face " + std::to_string(p) + " has other corners");
    }
  }
  if (own.Segments() != mesh.Segments()) refuse("segments have other ends");
  if (own.Representatives() != mesh.Representatives()) {
    refuse("other vertices are joined at seams");
  }
}

void BindMeshes(py::module_* module) {
  auto poses = BindPoses(module);
  BindContent(&poses);
  BindMaking(module);
  BindMeshFiles(module);
  BindMeshQueries(module);
  BindBodies(module);
  module->def("set_threads", &SetThreads);
  module->def("threads", &NumThreads);
}

}  // namespace shapespace::python
