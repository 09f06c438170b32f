#include <filesystem>
#include <memory>
#include <utility>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <shapespace/statistics/modes_file.h>
#include <shapespace/statistics/shape_model.h>

#include "arrays.h"
#include "bind.h"
#include "options.h"
#include "pickling.h"
#include "progress.h"
#include "unlocked.h"

namespace shapespace::python {
namespace {

using Model = std::shared_ptr<const ShapeModel>;

py::tuple Make(const Poses& poses, const std::vector<std::string>& names, const py::dict& given,
               const py::object& progress) {
  ShapeModelOptions options;
  Set(given, &options);
  options.Validate();
  auto [model, summary] = WithoutLock(progress, [=](Progress* told) {
    ShapeModelResult result =
        MakeShapeModel(poses.connectivity, poses.shapes, names, options, told);
    result.modes.appearance = poses.soup.appearance;
    result.modes.provenance = "shapespace " SHAPESPACE_VERSION " for Python: ShapeModel";
    return std::make_pair(std::make_shared<const ShapeModel>(std::move(result.modes)),
                          std::move(result.summary));
  });
  return py::make_tuple(std::const_pointer_cast<ShapeModel>(model), std::move(summary));
}

py::tuple At(const Model& model, const Eigen::VectorXd& coordinates, const py::object& progress) {
  const ModelShape found =
      WithoutLock(progress, [=](Progress* told) { return model->At(coordinates, told); });
  return py::make_tuple(FromShape(found.shape), found.Converged());
}

}  // namespace

void BindModels(py::module_* module) {
  module->def("make_shape_model", &Make);
  py::class_<ShapeModel, std::shared_ptr<ShapeModel>>(*module, "_ShapeModel")
      .def_static("read",
                  [](const std::filesystem::path& file) {
                    const Unlocked unlocked;
                    return std::make_shared<ShapeModel>(ReadModes(file));
                  })
      .def("write", [](const ShapeModel& model,
                       const std::filesystem::path& file) { WriteModes(file, model.Modes()); })
      .def(py::pickle([](const ShapeModel& model) { return Pack(model.Modes()); },
                      [](const py::bytes& bytes) {
                        auto modes = Unpack<PoseModes>(bytes);
                        const Unlocked unlocked;
                        return std::make_shared<ShapeModel>(std::move(modes));
                      }))
      .def_property_readonly("names", [](const ShapeModel& model) { return model.Modes().names; })
      .def_property_readonly(
          "faces",
          [](const ShapeModel& model) {
            return FromMatrix(model.Modes().metric->connectivity->FileTriangles());
          })
      .def_property_readonly("mean",
                             [](const ShapeModel& model) {
                               const PoseModes& modes = model.Modes();
                               return FromShape(modes.place(modes.metric->unit * modes.mean));
                             })
      .def_property_readonly(
          "modes",
          [](const ShapeModel& model) {
            std::vector<Shape> modes;
            for (const Tangent& mode : model.Modes().modes) {
              modes.push_back(model.Modes().place.rotation * (model.Modes().metric->unit * mode));
            }
            return FromShapes(modes);
          })
      .def_property_readonly("variance_ratio",
                             [](const ShapeModel& model) {
                               const PoseModes& modes = model.Modes();
                               return FromMatrix(Eigen::VectorXd(
                                   modes.variances / std::max(modes.total_variance, 1e-300)));
                             })
      .def_property_readonly("coordinates",
                             [](const ShapeModel& model) {
                               return FromMatrix(model.Modes().Coordinates().transpose().eval());
                             })
      .def("at",
           [](const std::shared_ptr<ShapeModel>& model, py::handle coordinates,
              const py::object& progress) {
             return At(model, ToVector(coordinates, "coordinates"), progress);
           })
      .def("preview",
           [](const ShapeModel& model, py::handle coordinates) {
             return FromShape(model.Preview(ToVector(coordinates, "coordinates")));
           })
      .def("sample",
           [](const ShapeModel& model, unsigned seed) { return FromMatrix(model.Sample(seed)); })
      .def("coordinates_of", [](const std::shared_ptr<ShapeModel>& model, py::handle vertices,
                                bool fit, const py::object& progress) {
        const int count = static_cast<int>(model->Modes().mean.cols());
        const Shape shape = ToPose(vertices, "shape", count);
        const ModelCoordinates found = WithoutLock(
            progress, [=](Progress* told) { return model->Coordinates(shape, fit, 0, told); });
        return py::make_tuple(FromMatrix(found.coordinates), FromShape(found.shape),
                              found.distance);
      });
}

}  // namespace shapespace::python
