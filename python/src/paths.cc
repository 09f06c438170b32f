#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <numeric>
#include <sstream>
#include <utility>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <shapespace/analysis/path_intersections.h>
#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/analysis/shape_error.h>
#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/files/write.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/output/frames.h>
#include <shapespace/output/gltf.h>
#include <shapespace/output/picture.h>
#include <shapespace/output/point_cache.h>
#include <shapespace/output/vertex_colours.h>
#include <shapespace/output/vtk.h>
#include <shapespace/path/anchor.h>
#include <shapespace/path/path_file.h>

#include "arrays.h"
#include "bind.h"
#include "options.h"
#include "progress.h"

namespace shapespace::python {
namespace {

// Pictures. ------------------------------------------------------------------------------------

py::array_t<unsigned char> Pixels(const RgbImage& image) {
  py::array_t<unsigned char> pixels(std::vector<py::ssize_t>{image.height, image.width, 3});
  std::copy(image.pixels.begin(), image.pixels.end(), pixels.mutable_data());
  return pixels;
}

void BindImage(py::module_* module) {
  py::class_<RgbImage>(
      *module, "Image",
      "A picture, such as a film strip; notebooks show it. `numpy.asarray` gives its "
      "pixels.")
      .def_property_readonly("pixels", &Pixels, "The pixels, height x width x 3 bytes, sRGB.")
      .def(
          "__array__",
          [](const RgbImage& image, const py::object& dtype, const py::object& /*copy*/) {
            return py::object(dtype.is_none() ? py::object(Pixels(image))
                                              : Pixels(image).attr("astype")(dtype));
          },
          py::arg("dtype") = py::none(), py::arg("copy") = py::none())
      .def(
          "png", [](const RgbImage& image) { return py::bytes(EncodePng(image)); },
          "The bytes of a PNG file.")
      .def("_repr_png_", [](const RgbImage& image) { return py::bytes(EncodePng(image)); })
      .def("_repr_html_",
           [](const RgbImage& image) {
             const auto text = py::module_::import("base64")
                                   .attr("b64encode")(py::bytes(EncodePng(image)))
                                   .attr("decode")("ascii");
             return "<img style=\"max-width: 100%\" src=\"data:image/png;base64," +
                    py::cast<std::string>(text) + "\"/>";
           })
      .def(
          "write",
          [](const RgbImage& image, const std::filesystem::path& file) {
            if (internal::FileExtension(file) != ".png") {
              throw FileError(file.string() + ": a picture is written as .png only");
            }
            WritePng(file, image);
          },
          py::arg("file"), "Writes a PNG file.")
      .def("__repr__", [](const RgbImage& image) {
        return "<shapespace.Image: " + std::to_string(image.width) + " x " +
               std::to_string(image.height) + " pixels>";
      });
}

RgbImage Draw(const std::shared_ptr<const Connectivity>& connectivity,
              const std::vector<Shape>& shapes, const FilmStripOptions& options) {
  return WithoutLock(py::none(),
                     [=](Progress*) { return RenderFilmStrip(*connectivity, shapes, options); });
}

FilmStripOptions StripOptions(const Path& path, const py::dict& given) {
  FilmStripOptions options;
  for (int i = 0; i < path.NumShapes(); ++i) {
    const bool pose = std::binary_search(path.poses.begin(), path.poses.end(), i);
    options.roles.push_back(pose                                       ? ShapeRole::kPose
                            : i < path.NumShapes() - path.extrapolated ? ShapeRole::kInserted
                                                                       : ShapeRole::kExtrapolated);
    std::ostringstream label;
    label << "t = " << std::setprecision(3) << path.parameters[i];
    options.labels.push_back(label.str());
  }
  Set(given, &options);
  return options;
}

// Metrics. -------------------------------------------------------------------------------------

// Both triangles of the metric's matrix, for tangents of shapes in the user's unit: data, row of
// each, where columns begin.
py::tuple FullMatrix(const FrozenMetric& self, const Shape& shape) {
  const auto full = WithoutLock(py::none(), [=](Progress*) {
    const double unit = self.metric->unit;
    const Eigen::SparseMatrix<double> lower =
        FeatureMap(self.metric).Derivative(shape / unit).MetricMatrix();
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

void BindMetric(py::module_* module) {
  py::class_<FrozenMetric>(*module, "Metric")
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
             const py::gil_scoped_release unlocked;
             return FrozenMetric{FreezeMetric(options, mesh.connectivity, mesh.shapes, 0, which)};
           }),
           py::arg("poses"), py::arg("faces") = py::none(), py::kw_only(),
           py::arg("preset") = "strain", py::arg("pairs") = "consecutive")
      .def_property_readonly(
          "unit", [](const FrozenMetric& self) { return self.metric->unit; },
          "The length, in the unit of the poses, that counts as 1.")
      .def_property_readonly(
          "options", [](const FrozenMetric& self) { return Get(self.metric->options); },
          "The options that it was made with, as a dict.")
      .def_property_readonly(
          "faces",
          [](const FrozenMetric& self) {
            return FromMatrix(self.metric->connectivity->Triangles());
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
          "Of each hinge: a third of its two triangles.")
      .def(
          "norm",
          [](const FrozenMetric& self, py::handle shape, py::handle tangent) {
            const int n = self.metric->connectivity->NumVertices();
            const Shape p = ToShape(shape, "shape", n), x = ToShape(tangent, "tangent", n);
            return WithoutLock(py::none(), [=](Progress*) {
              const double unit = self.metric->unit;
              return FeatureMap(self.metric).Derivative(p / unit).Times(x / unit).norm();
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

// Paths. ---------------------------------------------------------------------------------------

enum class Kind { kPath, kPicture, kGltf, kPointCache, kFrames, kVtk };

Kind KindOf(const std::string& file) {
  const std::string extension = internal::FileExtension(file);
  if (extension == ".path") return Kind::kPath;
  if (extension == ".png") return Kind::kPicture;
  if (extension == ".glb") return Kind::kGltf;
  if (extension == ".vtp") return Kind::kVtk;
  if (IsPointCache(file)) return Kind::kPointCache;
  if (IsWritableMesh(file)) return Kind::kFrames;
  throw FileError(file +
                  ": must end in .path, .png, .glb, .pc2, .mdd, .obj, .ply, .off, .stl or .vtp");
}

// Sets `value` to the one keyword, `known`, that a kind of file takes, if it is given.
template <typename T>
void OnlyKeyword(const py::dict& given, const std::string& known, T* value) {
  for (const auto& [key, keyword] : given) {
    const auto name = py::cast<std::string>(key);
    if (name != known) RefuseKeyword(name, {known});
    Value<T>::Set(value, keyword, name);
  }
}

std::vector<Eigen::MatrixXd> FrameColours(const Path& path, const std::string& color) {
  const py::gil_scoped_release unlocked;
  if (color == "deviation") return ColourByDeviation(path).of_shapes;
  if (color == "parts") return {path.shapes.size(), ColourByGroup(FindRigidParts(path).of_vertex)};
  if (color == "plain") return {};
  throw InvalidOptions("color", "must be plain, deviation or parts, not '" + color + "'");
}

void Write(const Path& path, const std::string& file, const py::dict& given) {
  const Kind kind = KindOf(file);
  if (kind == Kind::kPicture) {
    const FilmStripOptions options = StripOptions(path, given);
    WritePng(file, Draw(path.metric->connectivity, path.Placed(), options));
  } else if (kind == Kind::kGltf) {
    GltfOptions options;
    Set(given, &options);
    GltfSummary summary;
    {
      const py::gil_scoped_release unlocked;
      summary = WriteGltf(file, path, options);
    }
    Warn(summary.warnings);
  } else if (kind == Kind::kFrames) {
    std::string color = "plain";
    OnlyKeyword(given, "color", &color);
    const std::vector<Eigen::MatrixXd> colours = FrameColours(path, color);
    const py::gil_scoped_release unlocked;
    WriteFrames(file, path.Placed(), FrameSoup(*path.metric->connectivity, path.appearance),
                colours);
  } else if (kind == Kind::kPointCache) {
    double fps = 0;
    OnlyKeyword(given, "fps", &fps);
    const py::gil_scoped_release unlocked;
    given.empty() ? WritePointCache(file, path.Placed())
                  : WritePointCache(file, path.Placed(), fps);
  } else {
    if (!given.empty()) RefuseKeyword(py::cast<std::string>(given.begin()->first), {});
    const py::gil_scoped_release unlocked;
    kind == Kind::kPath ? WritePath(file, path) : WriteVtkSeries(file, path);
  }
}

// The file's bytes, through a temporary folder.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name)
      : folder_(py::module_::import("tempfile").attr("TemporaryDirectory")()),
        file_(std::filesystem::path(py::cast<std::string>(folder_.attr("name"))) / name) {}
  ~TemporaryFile() { folder_.attr("cleanup")(); }
  TemporaryFile(const TemporaryFile&) = delete;

  std::string Name() const { return file_; }

 private:
  const py::object folder_;
  const std::filesystem::path file_;
};

py::object BytesOf(const Path& path) {
  const TemporaryFile file("pickled.path");
  WritePath(file.Name(), path);
  const py::object bytes =
      py::module_::import("pathlib").attr("Path")(file.Name()).attr("read_bytes")();
  return bytes;
}

// `own_folder` is the appearance's, which is not the temporary one.
Path PathOf(const py::bytes& bytes, const py::bytes& own_folder) {
  const TemporaryFile file("pickled.path");
  py::module_::import("pathlib").attr("Path")(file.Name()).attr("write_bytes")(bytes);
  Path path = ReadPath(file.Name());
  path.appearance.own_folder = std::string(own_folder);
  return path;
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

size_t Position(py::ssize_t i, int count) {
  if (i < -count || i >= count) {
    throw py::index_error("shape " + std::to_string(i) + " of " + std::to_string(count));
  }
  return static_cast<size_t>(i < 0 ? i + count : i);
}

void BindPath(py::module_* module) {
  py::class_<Path>(*module, "Path", R"(A path of shapes: what solvers return.

A sequence of shapes, n x 3 each, where, and as large as, the poses are.

Parameters
----------
shapes : Poses, or sequence of array_like
    Shapes of one's own, n x 3, to transport or to transfer along.
metric : Metric
    Under which lengths on the path are measured.
parameters : array_like, optional
    The time of each shape, rising from 0; without, from 0 to 1 evenly.
)")
      .def(
          py::init([](py::handle shapes, const FrozenMetric& metric, const py::object& parameters) {
            if (py::isinstance<Poses>(shapes)) {
              return PathThrough(py::cast<const Poses&>(shapes), metric, parameters);
            }
            return PathThrough(MakePoses(ToShapes(shapes, "shapes"), py::cast(metric)), metric,
                               parameters);
          }),
          py::arg("shapes"), py::arg("metric"), py::arg("parameters") = py::none())
      .def_static(
          "read",
          [](const std::filesystem::path& file) {
            const py::gil_scoped_release unlocked;
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
    Its extension is the format: .path (everything, to continue from), .png (film strip), .glb
    (animation for browsers and Blender), .pc2 or .mdd (point cache for Blender, Maya, Houdini,
    3ds Max), numbered meshes such as frames/%03d.obj, .ply, .off or .stl, or frames/%03d.vtp with
    deviation and energy at every point, for ParaView.
**options
    Of `film_strip` for .png; of `GltfOptions` for .glb; for meshes `color`, which is 'plain',
    'deviation' or 'parts' (colours of vertices in .obj and .ply); for .mdd `fps`, shapes per
    second. The others take none.
)")
      .def("__len__", &Path::NumShapes)
      .def("__getitem__",
           [](const Path& path, py::ssize_t i) {
             return FromShape(path.Placed(static_cast<int>(Position(i, path.NumShapes()))));
           })
      .def("__getitem__",
           [](const Path& path, const py::slice& which) {
             return py::object(FromShapes(path.Placed())[which]);
           })
      .def_property_readonly(
          "vertices", [](const Path& path) { return FromShapes(path.Placed()); },
          "All shapes, k x n x 3, where, and as large as, the poses are.")
      .def_property_readonly(
          "aligned", [](const Path& path) { return FromShapes(path.shapes); },
          "All shapes, k x n x 3, aligned rigidly and centred, in the metric's unit: on these the "
          "geodesic equation holds.")
      .def_property_readonly(
          "faces",
          [](const Path& path) { return FromMatrix(path.metric->connectivity->Triangles()); },
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
      .def_readwrite("provenance", &Path::provenance, "Who made the path, from what.")
      .def(
          "at",
          [](const Path& path, py::handle times) {
            const Eigen::VectorXd numbers = ToVector(times, "times");
            return Resample(path, {numbers.data(), numbers.data() + numbers.size()});
          },
          py::arg("times"), R"(The path seen at other times.

Parameters
----------
times : array_like
    Rising, between the first and the last of `parameters`.

Returns
-------
Path
    With a shape at every time, by cubic interpolation between the shapes that there are.
)")
      .def(
          "first", [](const Path& path, int count) { return FirstShapes(path, count); },
          py::arg("count"), "The first `count` shapes as a path, to go on from.")
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
          "vertex lies at `height`.")
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
            const int n = path.metric->connectivity->NumVertices();
            py::array_t<double> all(std::vector<py::ssize_t>{path.NumShapes(), n});
            for (int i = 0; i < path.NumShapes(); ++i) {
              Eigen::Map<Eigen::VectorXd>(all.mutable_data(i, 0), n) = EdgeDeviation(path, i);
            }
            return all;
          },
          "Of every shape and vertex, k x n, how far the edges there are from their lengths in the "
          "first shape (.01 is one per cent).")
      .def(
          "rigid_parts",
          [](const Path& path) {
            const RigidParts parts =
                WithoutLock(py::none(), [=](Progress*) { return FindRigidParts(path); });
            return FromMatrix(parts.of_vertex);
          },
          "Of every vertex the near-rigid part of the body that it belongs to, the largest being "
          "0; -1 in joints.")
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
      .def("__repr__",
           [](const Path& path) {
             std::ostringstream text;
             text << "<shapespace.Path: " << path.NumShapes() << " shapes of "
                  << path.metric->connectivity->NumVertices() << " vertices, t = 0 .. "
                  << (path.parameters.empty() ? 0 : path.parameters.back());
             if (path.extrapolated > 0) text << ", " << path.extrapolated << " extrapolated";
             if (!path.converged) text << ", NOT CONVERGED";
             text << ">";
             return text.str();
           })
      .def(py::pickle(
          [](const Path& path) {
            const auto own_folder = std::filesystem::current_path() / path.appearance.own_folder;
            return py::make_tuple(BytesOf(path), py::bytes(own_folder.string()));
          },
          [](const py::tuple& state) { return PathOf(py::bytes(state[0]), py::bytes(state[1])); }));
}

}  // namespace

void BindPaths(py::module_* module) {
  BindImage(module);
  BindMetric(module);
  BindPath(module);
  module->def("film_strip", [](const Poses& poses, const py::dict& given) {
    FilmStripOptions options;
    Set(given, &options);
    return Draw(poses.connectivity, poses.shapes, options);
  });
  module->def("compare_shapes",
              [](const FrozenMetric& metric, py::handle reference, py::handle shape) {
                const int n = metric.metric->connectivity->NumVertices();
                return CompareShapes(metric.metric, ToShape(reference, "reference", n),
                                     ToShape(shape, "shape", n));
              });
}

}  // namespace shapespace::python
