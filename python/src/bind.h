#ifndef SHAPESPACE_PYTHON_BIND_H_
#define SHAPESPACE_PYTHON_BIND_H_

#include <memory>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include <shapespace/files/read.h>
#include <shapespace/metric/metric.h>
#include <shapespace/output/picture.h>
#include <shapespace/path/path.h>

// What the parts of the module share.

namespace shapespace::python {

namespace py = pybind11;

/// A metric, frozen: immutable, and shared with the paths that it makes.
struct FrozenMetric {
  std::shared_ptr<const Metric> metric;
};

/// What a function of Python's has raised that the library calls. It passes through the library and
/// the solvers, and is raised again where they return to Python. It is no std::exception, so that
/// nothing on the way takes it for an error of its own.
struct RaisedInPython {
  std::shared_ptr<py::error_already_set> error;
};

void BindErrors(py::module_* module);
void BindProgress();
void BindMeshes(py::module_* module);
void BindSummaries(py::module_* module);
void BindPictures(py::module_* module);
void BindFeatures(py::module_* module);
void BindMetrics(py::module_* module);
void BindPaths(py::module_* module);
void BindSpaces(py::module_* module);
void BindCorrespondence(py::module_* module);
void BindSolvers(py::module_* module);
void BindModels(py::module_* module);
void BindSkinning(py::module_* module);

/// What messages call the arguments of `MakePoses`.
struct ArgumentNames {
  std::vector<std::string> shapes;  ///< each; none: shapes[0], shapes[1], ...
  std::string faces = "faces";
};

/// The mesh that `faces` stands for: of a Poses, Path, Metric, Space or Body; or triangles or
/// polygons as in `SetPolygons`, on the vertices of `shapes`, which are checked as files are.
/// \throw py::type_error, py::value_error, MeshError, MismatchError.
Poses MakePoses(std::vector<Shape> shapes, py::handle faces, const ReadOptions& options = {},
                py::handle segments = py::none(), py::handle stiffeners = py::none(),
                const ArgumentNames& names = {});

/// Whether polygons are cut in the same way, and stiffeners, do not matter: they are the metric's.
/// \throw MeshError if the metric was frozen on another mesh: it would lend the poses its faces.
void CheckIsOfMesh(const Metric& metric, const Connectivity& mesh);

/// A film strip, drawn in a thread of its own.
RgbImage Draw(const std::shared_ptr<const Connectivity>& connectivity,
              const std::vector<Shape>& shapes, const FilmStripOptions& options);

/// The viewer that the package contains. \throw Error, of Python's, if it contains none.
std::string PageTemplate();

/// Says each through Python's warnings, as a MeshWarning.
void Warn(const std::vector<std::string>& warnings);

}  // namespace shapespace::python

#endif  // SHAPESPACE_PYTHON_BIND_H_
