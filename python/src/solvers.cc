#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <pybind11/stl.h>

#include <shapespace/base/error.h>
#include <shapespace/deformation/handle.h>
#include <shapespace/deformation/handle_file.h>
#include <shapespace/deformation/standing.h>

#include "arrays.h"
#include "bind.h"
#include "options.h"
#include "progress.h"

namespace shapespace::python {
namespace {

// Solvers' paths say who made them, as those of the tools do.
void Sign(const std::string& function, Path* path) {
  path->provenance = "shapespace " SHAPESPACE_VERSION " for Python: " + function;
}

template <typename Options>
Options FromKeywords(const py::dict& given) {
  Options options;
  Set(given, &options);
  options.Validate();
  return options;
}

// The key, taken out of the keywords, if it is a metric that is frozen already.
std::optional<FrozenMetric> TakeFrozen(const py::dict& given) {
  if (!given.contains("metric") || !py::isinstance<FrozenMetric>(given["metric"])) return {};
  return py::cast<FrozenMetric>(given.attr("pop")("metric"));
}

py::tuple InterpolatePoses(const Poses& poses, const py::dict& given, const py::object& progress) {
  const std::optional<FrozenMetric> frozen = TakeFrozen(given);
  const auto options = FromKeywords<GeodesicOptions>(given);
  if (frozen) CheckIsOfMesh(*frozen->metric, *poses.connectivity);
  GeodesicResult result = WithoutLock(progress, [=](Progress* told) {
    return frozen ? Interpolate(frozen->metric, poses.shapes, options, told)
                  : Interpolate(poses, options, told);
  });
  result.path.appearance = poses.soup.appearance;
  Sign("interpolate", &result.path);
  return py::make_tuple(std::move(result.path), std::move(result.summary));
}

py::tuple SplineThrough(const Poses& poses, const py::dict& given, const py::object& progress) {
  const auto options = FromKeywords<SplineOptions>(given);
  SplineResult result =
      WithoutLock(progress, [=](Progress* told) { return Spline(poses, options, told); });
  Sign("spline", &result.path);
  return py::make_tuple(std::move(result.path), std::move(result.summary));
}

py::tuple AverageOf(const Poses& poses, const py::dict& given, const py::object& progress) {
  const auto options = FromKeywords<AverageOptions>(given);
  AverageResult result =
      WithoutLock(progress, [=](Progress* told) { return Average(poses, options, told); });
  return py::make_tuple(FromShape(result.shape), std::move(result.summary));
}

// Parts are pairs of vertices and poses, as `shapespace.stand` has them.
py::tuple Stand(Path path, const py::list& parts, const py::object& progress) {
  std::vector<StandingPart> standing;
  for (py::handle part : parts) {
    const auto& [vertices, poses] =
        py::cast<std::pair<py::object, std::vector<std::pair<int, int>>>>(part);
    standing.push_back(
        {"", ToVertices(vertices, "vertices", path.metric->connectivity->NumVertices()), poses});
  }
  StandingSummary summary = WithoutLock(progress, [&](Progress* told) {
    return HoldStandingParts(path, standing, StandingDefaults(), &path, told);
  });
  return py::make_tuple(std::move(path), std::move(summary));
}

// A handle as Python has it: vertices, and where they are to be.
DeformationHandle MakeHandle(py::handle vertices, const py::object& positions, py::handle axis,
                             double angle, py::handle point, py::handle translation, bool hard,
                             double weight, const std::string& name) {
  DeformationHandle handle;
  handle.name = name;
  // Whether they exist is for the solver to say, which has the mesh.
  const py::array given = py::array::ensure(vertices);
  const int most = given && given.dtype().kind() == 'b' ? static_cast<int>(given.size())
                                                        : std::numeric_limits<int>::max();
  handle.vertices = ToVertices(vertices, "vertices", most);
  if (!positions.is_none()) {
    const py::array array = py::array::ensure(positions);
    const bool single = array && array.ndim() == 1;
    handle.positions = ToShape(single ? py::object(py::make_tuple(positions)) : positions,
                               "positions", static_cast<int>(handle.vertices.size()));
  }
  Value<Eigen::Vector3d>::Set(&handle.motion.axis, axis, "axis");
  Value<Eigen::Vector3d>::Set(&handle.motion.point, point, "point");
  Value<Eigen::Vector3d>::Set(&handle.motion.translation, translation, "translation");
  handle.motion.angle = angle;
  handle.hard = hard;
  handle.weight = weight;
  return handle;
}

void BindHandle(py::module_* module) {
  const DeformationHandle none;
  const auto vector = [](const Eigen::Vector3d& value) {
    return Value<Eigen::Vector3d>::Get(value);
  };
  py::class_<DeformationHandle>(*module, "Handle",
                                R"(Some vertices, and where they are to be in the end.

Parameters
----------
vertices : array_like
    Numbers of vertices, or a truth value for each vertex of the mesh.
positions : array_like, optional
    Where each of them is to be, k x 3; without, they move as below, and by default stay.
axis : array_like, optional
    The direction about which they turn.
angle : float, optional
    By which, in radians. Turns of half a circle and more are what they say.
point : array_like, optional
    A point on the axis.
translation : array_like, optional
    By which they move.
hard : bool, optional
    Met exactly; a soft handle pulls.
weight : float, optional
    Of a soft handle.
name : str, optional
    For messages and reports.
)")
      .def(py::init(&MakeHandle), py::arg("vertices"), py::arg("positions") = py::none(),
           py::kw_only(), py::arg("axis") = vector(none.motion.axis),
           py::arg("angle") = none.motion.angle, py::arg("point") = vector(none.motion.point),
           py::arg("translation") = vector(none.motion.translation), py::arg("hard") = none.hard,
           py::arg("weight") = none.weight, py::arg("name") = none.name)
      .def(py::pickle(
          [](const DeformationHandle& handle) {
            const ScrewMotion& motion = handle.motion;
            py::object positions = py::none();
            if (handle.positions) positions = FromShape(*handle.positions);
            const auto vector = &Value<Eigen::Vector3d>::Get;
            return py::make_tuple(handle.vertices, positions, vector(motion.axis), motion.angle,
                                  vector(motion.point), vector(motion.translation), handle.hard,
                                  handle.weight, handle.name);
          },
          [](const py::tuple& state) {
            return MakeHandle(state[0], state[1], state[2], py::cast<double>(state[3]), state[4],
                              state[5], py::cast<bool>(state[6]), py::cast<double>(state[7]),
                              py::cast<std::string>(state[8]));
          }))
      .def_readonly("name", &DeformationHandle::name)
      .def_readonly("vertices", &DeformationHandle::vertices)
      .def_readonly("hard", &DeformationHandle::hard)
      .def_readonly("weight", &DeformationHandle::weight)
      .def("__repr__", [](const DeformationHandle& handle) {
        return "<shapespace.Handle: " + (handle.name.empty() ? "" : "'" + handle.name + "', ") +
               std::to_string(handle.vertices.size()) + " vertices, " +
               (handle.hard ? "hard" : "soft") + ">";
      });
  module->def("read_handles", [](const std::string& file, const Poses& mesh) {
    return ReadHandles(file, mesh.shapes[0], *mesh.connectivity, mesh.soup.appearance);
  });
}

// The metric of the mesh is the default, of which options may say otherwise.
DeformationOptions DeformationFromKeywords(const Poses& mesh, const py::dict& given) {
  DeformationOptions options;
  options.metric = MetricOptions::Deformation(*mesh.connectivity, mesh.shapes[0]);
  Set(given, &options);
  options.Validate();
  return options;
}

void BindInterpolator(py::module_* module) {
  py::class_<Interpolator, std::shared_ptr<Interpolator>>(*module, "_Interpolator")
      .def(py::init([](const Poses& poses, const py::dict& given) {
        const auto options = FromKeywords<GeodesicOptions>(given);
        return WithoutLock(py::none(), [=](Progress*) {
          return std::make_shared<Interpolator>(poses.connectivity, poses.shapes, options);
        });
      }))
      .def_property_readonly(
          "metric",
          [](const Interpolator& interpolator) { return FrozenMetric{interpolator.GetMetric()}; })
      .def("between", [](const std::shared_ptr<Interpolator>& interpolator, const Poses& ends,
                         const py::object& progress) {
        GeodesicResult result = WithoutLock(progress, [=](Progress* told) {
          return interpolator->Between(ends.shapes[0], ends.shapes[1], told);
        });
        result.path.appearance = ends.soup.appearance;
        Sign("interpolate", &result.path);
        return py::make_tuple(std::move(result.path), std::move(result.summary));
      });
}

void BindDeformer(py::module_* module) {
  // Shared with the last call, in case that is abandoned; the next call waits for it.
  py::class_<Deformer, std::shared_ptr<Deformer>>(*module, "_Deformer")
      .def(py::init([](const Poses& mesh, const py::dict& given) {
        const DeformationOptions options = DeformationFromKeywords(mesh, given);
        return WithoutLock(py::none(), [=](Progress*) {
          return Deformer(mesh.connectivity, mesh.shapes[0], options);
        });
      }))
      .def("deform", [](const std::shared_ptr<Deformer>& deformer,
                        const std::vector<DeformationHandle>& handles, const py::object& progress) {
        DeformationResult result =
            WithoutLock(progress, [=](Progress* told) { return deformer->Deform(handles, told); });
        Sign("deform", &result.path);
        return py::make_tuple(std::move(result.path), std::move(result.summary));
      });
}

void BindShooting(py::module_* module) {
  module->def("extrapolate",
              [](const Path& path, int steps, const py::dict& given, const py::object& progress) {
                const auto options = FromKeywords<ExponentialOptions>(given);
                ExponentialResult result = WithoutLock(progress, [=](Progress* told) {
                  return Extrapolate(path, steps, options, told);
                });
                Sign("extrapolate", &result.path);
                return py::make_tuple(std::move(result.path), std::move(result.summary));
              });
  module->def("shoot", [](const FrozenMetric& metric, py::handle shape, py::handle velocity,
                          int steps, const py::dict& given, const py::object& progress) {
    const int n = metric.metric->connectivity->NumVertices();
    const Shape from = ToShape(shape, "shape", n), along = ToShape(velocity, "velocity", n);
    const auto options = FromKeywords<ExponentialOptions>(given);
    ExponentialResult result = WithoutLock(progress, [=](Progress* told) {
      return Extrapolate(metric.metric, from, along, steps, options, told);
    });
    Sign("shoot", &result.path);
    return py::make_tuple(std::move(result.path), std::move(result.summary));
  });
  module->def("exponential", [](const FrozenMetric& metric, py::handle shape, py::handle velocity,
                                int steps, const py::dict& given, const py::object& progress) {
    const int n = metric.metric->connectivity->NumVertices();
    const Shape from = ToShape(shape, "shape", n), along = ToShape(velocity, "velocity", n);
    const auto options = FromKeywords<ExponentialOptions>(given);
    return FromShape(WithoutLock(progress, [=](Progress* told) {
      return Exponential(metric.metric, from, along, steps, options, told);
    }));
  });
  module->def("logarithm", [](const FrozenMetric& metric, py::handle from, py::handle to, int steps,
                              const py::dict& given, const py::object& progress) {
    const int n = metric.metric->connectivity->NumVertices();
    const Shape first = ToPose(from, "shape", n), last = ToPose(to, "end", n);
    if (steps < 2) throw py::value_error("steps: must be at least 2");
    LogarithmOptions options;
    Set(given, &options);
    options.shapes = steps - 1;
    options.Validate();
    return FromShape(WithoutLock(progress, [=](Progress* told) {
      return Logarithm(metric.metric, first, last, options, told);
    }));
  });
  module->def("transport", [](const Path& path, py::handle tangents, const py::dict& given,
                              const py::object& progress) {
    const std::vector<Tangent> carried =
        ToShapes(tangents, "tangents", path.metric->connectivity->NumVertices());
    const auto options = FromKeywords<TransportOptions>(given);
    TransportResult result = WithoutLock(
        progress, [=](Progress* told) { return Transport(path, carried, options, told); });
    return py::make_tuple(FromShapes(result.tangents), std::move(result.summary));
  });
  module->def(
      "correct_path", [](const Path& path, const py::dict& given, const py::object& progress) {
        const auto options = FromKeywords<CorrectionOptions>(given);
        CorrectionResult result =
            WithoutLock(progress, [=](Progress* told) { return CorrectPath(path, options, told); });
        Sign("correct_path", &result.path);
        return py::make_tuple(std::move(result.path), std::move(result.summary));
      });
}

template <typename Result>
py::tuple FinishTransfer(const std::string& function, const Appearance& appearance, Result result) {
  result.path.appearance = result.hybrids.appearance = appearance;
  Sign(function, &result.path);
  Sign(function + ", hybrids", &result.hybrids);
  py::object hybrids = py::none();
  if (result.hybrids.NumShapes() > 0) hybrids = py::cast(std::move(result.hybrids));
  return py::make_tuple(std::move(result.path), hybrids, std::move(result.summary));
}

void BindTransfer(py::module_* module) {
  module->def("transfer", [](const Path& source, py::handle target, const py::dict& given,
                             const py::object& progress) {
    const Shape shape = ToPose(target, "target", source.metric->connectivity->NumVertices());
    const auto options = FromKeywords<TransferOptions>(given);
    return FinishTransfer("transfer", source.appearance, WithoutLock(progress, [=](Progress* told) {
                            return Transfer(source, shape, options, told);
                          }));
  });
  module->def("transfer_poses", [](const Poses& poses, py::handle target,
                                   const py::object& geodesic, const py::dict& given,
                                   const py::object& progress) {
    const Shape shape = ToPose(target, "target", poses.connectivity->NumVertices());
    GeodesicOptions on_the_way;
    Value<GeodesicOptions>::Set(&on_the_way, geodesic, "geodesic");
    on_the_way.Validate();
    const auto options = FromKeywords<TransferOptions>(given);
    return FinishTransfer(
        "transfer_poses", poses.soup.appearance, WithoutLock(progress, [=](Progress* told) {
          return TransferPoses(poses.connectivity, poses.shapes, shape, on_the_way, options, told);
        }));
  });
}

}  // namespace

void BindSolvers(py::module_* module) {
  module->def("interpolate", &InterpolatePoses);
  module->def("spline", &SplineThrough);
  module->def("stand", &Stand);
  module->def("average", &AverageOf);
  BindShooting(module);
  BindTransfer(module);
  BindHandle(module);
  BindDeformer(module);
  BindInterpolator(module);
  module->def("deform", [](const Poses& mesh, const std::vector<DeformationHandle>& handles,
                           const py::dict& given, const py::object& progress) {
    const DeformationOptions options = DeformationFromKeywords(mesh, given);
    DeformationResult result = WithoutLock(progress, [=](Progress* told) {
      return Deform(mesh.connectivity, mesh.shapes[0], handles, options, told);
    });
    result.path.appearance = mesh.soup.appearance;
    Sign("deform", &result.path);
    return py::make_tuple(std::move(result.path), std::move(result.summary));
  });
  module->def("repair", [](const Poses& reference, py::handle distorted, py::handle vertices,
                           const py::dict& given, const py::object& progress) {
    const int n = reference.connectivity->NumVertices();
    const Shape shape = ToPose(distorted, "distorted", n);
    RepairOptions options;
    options.deformation.metric =
        MetricOptions::Deformation(*reference.connectivity, reference.shapes[0]);
    Set(given, &options);
    options.deformation.Validate();
    if (!vertices.is_none()) options.vertices = ToVertices(vertices, "vertices", n);
    RepairResult result = WithoutLock(progress, [=](Progress* told) {
      return Repair(reference.connectivity, reference.shapes[0], shape, options, told);
    });
    result.path.appearance = reference.soup.appearance;
    Sign("repair", &result.path);
    return py::make_tuple(std::move(result.path), std::move(result.summary));
  });
}

}  // namespace shapespace::python
