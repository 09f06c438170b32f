#include <filesystem>
#include <numeric>
#include <sstream>
#include <utility>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <shapespace/analysis/path_intersections.h>
#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/analysis/vertex_energy.h>
#include <shapespace/base/error.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/output/path_output.h>
#include <shapespace/path/anchor.h>
#include <shapespace/path/path_file.h>

#include "arrays.h"
#include "bind.h"
#include "options.h"
#include "pickling.h"
#include "progress.h"
#include "unlocked.h"

namespace shapespace::python {
namespace {

FilmStripOptions StripOptions(const Path& path, const py::dict& given) {
  FilmStripOptions options = FilmStripOf(path);
  Set(given, &options);
  return options;
}

void RefuseOthers(const py::dict& given, const std::vector<std::string>& known) {
  if (!given.empty()) RefuseKeyword(py::cast<std::string>(given.begin()->first), known);
}

void Write(const Path& path, const std::string& file, const py::dict& given) {
  using Kind = PathOutput::Kind;
  const PathOutput output = PathOutput::Of(file, path.NumShapes() == 1);
  PathOutputOptions options;
  std::vector<std::string> taken;
  const auto take = [&](const std::string& name, auto* value) {
    taken.push_back(name);
    if (!given.contains(name.c_str())) return;
    Value<std::decay_t<decltype(*value)>>::Set(value, given.attr("pop")(name), name);
  };
  switch (output.kind) {
    case Kind::kFilmStrip:
      take("color", &options.colours);
      Set(given, &options.film_strip, taken);
      break;
    case Kind::kPictures:
    case Kind::kFilm:
      take("color", &options.colours);
      take("width", &options.film_width);
      if (output.kind == Kind::kFilm) {
        take("duration", &options.gltf.duration);
        take("fps", &options.gltf.fps);
        take("playback", &options.gltf.playback);
        take("ease", &options.gltf.ease);
      }
      Set(given, &options.film_strip, taken);
      break;
    case Kind::kGltf:
      take("color", &options.colours);
      Set(given, &options.gltf, taken);
      break;
    case Kind::kFrames:
    case Kind::kLastShape:
      take("color", &options.colours);
      RefuseOthers(given, taken);
      break;
    case Kind::kPointCache:
      take("fps", &options.point_cache_fps);
      RefuseOthers(given, taken);
      break;
    case Kind::kUsd: {
      std::string up(1, options.usd.up);
      take("color", &options.colours);
      take("fps", &options.usd.fps);
      take("up", &up);
      take("unit", &options.usd.unit);
      if (up.size() != 1) throw InvalidOptions("up", "must be 'y' or 'z'");
      options.usd.up = up[0];
      RefuseOthers(given, taken);
      break;
    }
    case Kind::kPage:
      RefuseOthers(given, taken);
      options.page_template = PageTemplate();
      break;
    default:
      RefuseOthers(given, taken);
  }
  PathOutputSummary summary;
  {
    const Unlocked unlocked;
    summary = WritePathOutput(output, path, options);
  }
  Warn(summary.warnings);
}

Path PathThrough(const Poses& poses, const FrozenMetric& metric, const py::object& parameters) {
  std::vector<double> times;
  if (!parameters.is_none()) {
    const Eigen::VectorXd given = ToVector(parameters, "parameters");
    times.assign(given.data(), given.data() + given.size());
  }
  CheckIsOfMesh(*metric.metric, *poses.connectivity);
  Path path = MakePath(metric.metric, poses.shapes, std::move(times));
  path.poses.resize(path.shapes.size());
  std::iota(path.poses.begin(), path.poses.end(), 0);
  path.appearance = poses.soup.appearance;
  return path;
}

// Where an object keeps its array of vertices.
constexpr char kVertices[] = "_vertices";

// The shapes that a slice of a path names.
std::vector<int> IndicesOf(const py::slice& slice, int count) {
  py::ssize_t begin, end, step, number;
  if (!slice.compute(count, &begin, &end, &step, &number)) throw py::error_already_set();
  std::vector<int> indices;
  for (py::ssize_t k = 0; k < number; ++k) indices.push_back(static_cast<int>(begin + k * step));
  return indices;
}

// Files, and copies in other processes.
void BindFiles(py::class_<Path>* path) {
  (*path)
      .def_static(
          "read",
          [](const std::filesystem::path& file) {
            const Unlocked unlocked;
            return ReadPath(file);
          },
          py::arg("file"), "Reads a .path file.")
      .def(
          "write",
          [](const Path& path, const std::filesystem::path& file, const py::kwargs& options) {
            Write(path, file, options);
          },
          py::arg("file"), R"(Writes the path; the file appears whole or not at all.

Parameters
----------
file : str or path-like
    Its extension is the format: .path (everything, to continue from), .png (film strip), .gif
    or .apng (moving picture), .glb (animation for browsers and Blender), .usda (animation, text of
    USD), .html (a page for browsers), .pc2 or .mdd (point cache for Blender, Maya, Houdini, 3ds
    Max), numbered meshes such as frames/%03d.obj, .ply, .off or .stl, numbered pictures
    (frames/%03d.png), or frames/%03d.vtp with deviation and energy at every point, for ParaView.
**options
    Of `film_strip` for .png; the same for numbered pictures, .gif and .apng, with `width`, the
    longer side in pixels, and for .gif and .apng `duration`, `fps`, `playback` and `ease` of
    `GltfOptions`; all of these for .glb; for these, .usda and meshes `color`, which
    is 'plain', 'deviation' or 'parts' (colours of vertices in .obj and .ply); for .mdd and .usda
    `fps`, shapes per second; for .usda also `up`, 'y' or 'z', and `unit`, metres in one of the
    shapes' units. The others take none.
)")
      .def(Pickle<Path>());
}

// What a path has.
void BindShapes(py::class_<Path>* path) {
  (*path)
      .def("__len__", &Path::NumShapes)
      .def("__getitem__",
           [](const Path& path, py::ssize_t i) {
             return FromShape(
                 path.Placed(static_cast<int>(PositionIn(i, path.NumShapes(), "shape"))));
           })
      .def("__getitem__",
           [](const Path& path, const py::slice& which) {
             const std::vector<int> indices = IndicesOf(which, path.NumShapes());
             if (indices.empty()) throw py::index_error("the slice has no shape");
             return SelectShapes(path, indices);
           })
      .def_property_readonly(
          "vertices",
          [](const py::object& self) {
            const py::object own = self.attr("__dict__");
            if (!own.contains(kVertices)) {
              py::array_t<double> vertices = FromShapes(py::cast<const Path&>(self).Placed());
              vertices.attr("setflags")(py::arg("write") = false);
              own[kVertices] = vertices;
            }
            return py::object(own[kVertices]);
          },
          "All shapes, k x n x 3, where, and as large as, the poses are: read-only, and made when "
          "it is first asked for. `path[i]` makes one shape alone.")
      .def_property_readonly(
          "aligned", [](const Path& path) { return FromShapes(path.shapes); },
          "All shapes, k x n x 3, aligned rigidly and centred, in the metric's unit: on these the "
          "geodesic equation holds.")
      .def_property_readonly(
          "faces",
          [](const Path& path) { return FromMatrix(path.metric->connectivity->FileTriangles()); },
          "The triangles, m x 3.")
      .def_property_readonly(
          "metric", [](const Path& path) { return FrozenMetric{path.metric}; },
          "The metric that made the path.")
      .def_property_readonly(
          "parameters",
          [](const Path& path) {
            return py::array_t<double>(static_cast<py::ssize_t>(path.parameters.size()),
                                       path.parameters.data());
          },
          "The time of every shape; the poses end at 1, and what is extrapolated goes on.")
      .def_readonly("poses", &Path::poses, "Which of the shapes were given.")
      .def_readonly("extrapolated", &Path::extrapolated,
                    "How many of the last shapes were extrapolated.")
      .def_readonly("converged", &Path::converged, "False if a solve ended before it was done.")
      .def_readonly("smooth", &Path::smooth, "Whether the velocity is continuous at inner poses.")
      .def_readwrite("provenance", &Path::provenance, "Who made the path, from what.");
}

// Paths made of it.
void BindChanges(py::class_<Path>* path) {
  (*path)
      .def(
          "at",
          [](const Path& path, py::handle times) -> py::object {
            if (const py::array one = py::array::ensure(times); one && one.ndim() == 0) {
              return FromShape(Resample(path, {py::cast<double>(py::float_(one))}).Placed(0));
            }
            const Eigen::VectorXd numbers = ToVector(times, "times");
            return py::cast(Resample(path, {numbers.data(), numbers.data() + numbers.size()}));
          },
          py::arg("times"), R"(The path seen at other times.

Parameters
----------
times : float or array_like
    Between the first and the last of `parameters`; several rise.

Returns
-------
ndarray or Path
    At one time the shape, n x 3. At several a path with a shape at every time. Both by cubic
    interpolation between the shapes that there are.
)")
      .def(
          "anchor",
          [](const Path& path, py::handle vertices) {
            Path anchored = path;
            Anchor(&anchored,
                   ToVertices(vertices, "vertices", path.metric->connectivity->NumVertices()));
            return anchored;
          },
          py::arg("vertices"), R"(The path with shapes moved rigidly so that a part stands still.

Parameters
----------
vertices : array_like
    The part: numbers of vertices, or a truth value for each. Where two poses have it in the same
    place, it stands still between them; else it moves rigidly from one to the other.

Returns
-------
Path
)")
      .def(
          "ground",
          [](const Path& path, const std::string& axis, double height) {
            if (axis != "x" && axis != "y" && axis != "z") {
              throw py::value_error("axis: must be 'x', 'y' or 'z', not '" + axis + "'");
            }
            Path grounded = path;
            Ground(&grounded, axis[0] - 'x', height);
            return grounded;
          },
          py::arg("axis"), py::arg("height") = 0.0,
          "The path with every shape moved along an axis ('x', 'y' or 'z') so that its lowest "
          "vertex lies at `height`.");
}

// What is computed of it.
void BindMeasures(py::class_<Path>* path) {
  (*path)
      .def(
          "initial_velocity",
          [](const Path& path) {
            return FromShape(
                WithoutLock(py::none(), [=](Progress*) { return InitialVelocity(path); }));
          },
          "The velocity, n x 3, with which the path sets out, per unit of its parameter.")
      .def(
          "quality",
          [](const Path& path) {
            return WithoutLock(py::none(), [=](Progress*) { return MeasureQuality(path); });
          },
          "Figures of how far edges are from the lengths that they should have, of wrinkles and of "
          "folds.")
      .def(
          "intersections",
          [](const Path& path) {
            const PathIntersections found =
                WithoutLock(py::none(), [=](Progress*) { return MeasureIntersections(path); });
            return py::array_t<std::int64_t>(static_cast<py::ssize_t>(found.pairs.size()),
                                             found.pairs.data());
          },
          "Of every shape the number of pairs of triangles that pass through each other.")
      .def(
          "edge_deviation",
          [](const Path& path) {
            std::vector<Eigen::VectorXd> all;
            for (int i = 0; i < path.NumShapes(); ++i) all.push_back(EdgeDeviation(path, i));
            return FromVectors(all);
          },
          "Of every shape and vertex, k x n, how far the edges there are from their lengths in the "
          "first shape (.01 is one per cent).")
      .def(
          "rigid_parts",
          [](const Path& path, double tolerance, double least_share, double most_deviation) {
            const RigidPartsOptions options = {tolerance, least_share, most_deviation};
            const RigidParts parts =
                WithoutLock(py::none(), [=](Progress*) { return FindRigidParts(path, options); });
            return FromMatrix(parts.of_vertex);
          },
          py::arg("tolerance") = RigidPartsOptions().tolerance,
          py::arg("least_share") = RigidPartsOptions().least_share,
          py::arg("most_deviation") = RigidPartsOptions().most_deviation,
          R"(The near-rigid parts of the body.

Parameters
----------
tolerance : float, optional
    How far a part may be from moving rigidly, as a share of the root of its area.
least_share : float, optional
    Of the surface: what is smaller is no part.
most_deviation : float, optional
    What has edges that deviate by more from the first shape is no part.

Returns
-------
ndarray
    Of every vertex the part that it belongs to, the largest being 0; -1 in joints.
)")
      .def(
          "vertex_energy",
          [](const Path& path) {
            return FromVectors(
                WithoutLock(py::none(), [=](Progress*) { return VertexEnergy(path); }));
          },
          "Of every shape and vertex, k x n, what the motion costs there: squared speed per area, "
          "so that the sum over `metric.vertex_area` is the squared speed of the shape.");
}

// How it is shown.
void BindDisplay(py::class_<Path>* path) {
  (*path)
      .def("_film_strip",
           [](const Path& path, const py::dict& given) {
             return Draw(path.metric->connectivity, path.Placed(), StripOptions(path, given));
           })
      .def("_repr_html_",
           [](const Path& path) {
             const py::object strip =
                 py::cast(Draw(path.metric->connectivity, path.Placed(), StripOptions(path, {})));
             return strip.attr("_repr_html_")();
           })
      .def("__repr__", [](const Path& path) {
        std::ostringstream text;
        text << "<shapespace.Path: " << path.NumShapes() << " shapes of "
             << path.metric->connectivity->NumVertices() << " vertices, t = 0 .. "
             << (path.parameters.empty() ? 0 : path.parameters.back());
        if (path.extrapolated > 0) text << ", " << path.extrapolated << " extrapolated";
        if (!path.converged) text << ", NOT CONVERGED";
        text << ">";
        return text.str();
      });
}

}  // namespace

void BindPaths(py::module_* module) {
  py::class_<Path> path(*module, "Path", py::dynamic_attr(),
                        R"(A path of shapes: what solvers return.

A sequence of shapes, n x 3 each, where, and as large as, the poses are.

Parameters
----------
shapes : Poses, or sequence of array_like
    Shapes of one's own, n x 3, to transport or to transfer along.
metric : Metric
    Under which lengths on the path are measured.
parameters : array_like, optional
    The time of each shape, rising from 0; without, from 0 to 1 evenly.
)");
  path.def(
      py::init([](py::handle shapes, const FrozenMetric& metric, const py::object& parameters) {
        if (py::isinstance<Poses>(shapes)) {
          return PathThrough(py::cast<const Poses&>(shapes), metric, parameters);
        }
        return PathThrough(MakePoses(ToShapes(shapes, "shapes"), py::cast(metric)), metric,
                           parameters);
      }),
      py::arg("shapes"), py::arg("metric"), py::arg("parameters") = py::none());
  BindFiles(&path);
  BindShapes(&path);
  BindChanges(&path);
  BindMeasures(&path);
  BindDisplay(&path);
}

}  // namespace shapespace::python
