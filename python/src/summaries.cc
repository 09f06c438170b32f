#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include <shapespace/correspondence/internal/summary_fields.h>
#include <shapespace/deformation/internal/summary_fields.h>
#include <shapespace/exploration/internal/summary_fields.h>
#include <shapespace/exponential/internal/summary_fields.h>
#include <shapespace/skinning/internal/summary_fields.h>
#include <shapespace/spline/internal/summary_fields.h>
#include <shapespace/statistics/internal/summary_fields.h>
#include <shapespace/transfer/internal/summary_fields.h>

#include "bind.h"
#include "options.h"

// What solvers say of what they did, as objects with the attributes that C++ has.

namespace shapespace::python {
namespace {

template <typename T>
py::object ToPython(const T& value) {
  if constexpr (std::is_enum_v<T>) {
    return py::str(internal::WordOf(value));
  } else if constexpr (std::is_same_v<T, std::vector<std::pair<std::string, double>>>) {
    return py::dict(py::cast(value));
  } else {
    return py::cast(value);
  }
}

/// The inverse.
template <typename T>
T FromPython(py::handle value) {
  if constexpr (std::is_enum_v<T>) {
    return internal::FromWord<T>(py::cast<std::string>(value)).value();
  } else if constexpr (std::is_same_v<T, std::vector<std::pair<std::string, double>>>) {
    return py::cast<T>(py::list(value.attr("items")()));
  } else {
    return py::cast<T>(value);
  }
}

/// A value's type as stubs have it. Classes must have been bound before.
template <typename T>
std::string TypeInStub(const T* = nullptr) {
  if constexpr (std::is_same_v<T, bool>) {
    return "bool";
  } else if constexpr (std::is_integral_v<T>) {
    return "int";
  } else if constexpr (std::is_floating_point_v<T>) {
    return "float";
  } else if constexpr (std::is_convertible_v<T, std::string>) {
    return "str";
  } else if constexpr (std::is_enum_v<T>) {
    return "Literal[" + internal::ListWords<T>("\"") + "]";
  } else {
    return py::cast<std::string>(py::type::of<T>().attr("__name__"));
  }
}
template <typename T>
std::string TypeInStub(const std::vector<T>* = nullptr) {
  return "list[" + TypeInStub(static_cast<const T*>(nullptr)) + "]";
}
inline std::string TypeInStub(const std::vector<std::pair<std::string, double>>* = nullptr) {
  return "dict[str, float]";
}

/// A class with read-only attributes, and a repr that lists them.
template <typename T>
class Record {
 public:
  Record(py::module_* module, const char* name, const char* doc) : class_(*module, name, doc) {
    class_.def("__repr__", [](const py::object& self) {
      std::string text;
      const py::object type = py::type::of(self);
      for (py::handle field : type.attr("_fields")) {
        text += (text.empty() ? "" : ", ") + py::cast<std::string>(field) + "=" +
                py::cast<std::string>(py::repr(self.attr(field)));
      }
      return py::cast<std::string>(type.attr("__name__")) + "(" + text + ")";
    });
    // Its own fields; others are computed of them.
    class_.def(py::pickle(
        [](const T& self) {
          py::dict state;
          internal::ForFields(internal::Of<T>(), [&](const char* field, const auto& get) {
            if constexpr (std::is_member_object_pointer_v<std::decay_t<decltype(get)>>) {
              state[field] = ToPython(self.*get);
            }
          });
          return state;
        },
        [](const py::dict& state) {
          T made;
          internal::ForFields(internal::Of<T>(), [&](const char* field, const auto& get) {
            if constexpr (std::is_member_object_pointer_v<std::decay_t<decltype(get)>>) {
              made.*get = FromPython<std::decay_t<decltype(made.*get)>>(state[field]);
            }
          });
          return made;
        }));
    py::list fields, types;
    internal::ForFields(internal::Of<T>(), [&](const char* field, const auto& get) {
      class_.def_property_readonly(
          field, [get](const T& self) { return ToPython(std::invoke(get, self)); });
      using Value = std::decay_t<std::invoke_result_t<decltype(get), const T&>>;
      fields.append(field);
      types.append(TypeInStub(static_cast<const Value*>(nullptr)));
    });
    class_.attr("_fields") = fields;
    class_.attr("_types") = types;
  }

  /// A summary's: its line as repr; its page, where it has one, as str; all of it as a dict.
  template <bool full, bool json>
  Record& Reports() {
    class_.def(
        "__repr__",
        [](const py::object& self) {
          const auto& summary = py::cast<const T&>(self);
          return "<" + py::cast<std::string>(py::type::of(self).attr("__name__")) + ": " +
                 summary.BriefReport() + ">";
        },
        py::prepend());
    class_.def("__str__", [](const T& self) {
      if constexpr (full) {
        return self.FullReport();
      } else {
        return self.BriefReport();
      }
    });
    if constexpr (json) {
      class_.def(
          "to_dict",
          [](const T& self) { return py::module_::import("json").attr("loads")(self.ToJson()); },
          "All of it as a dict, as --report report.json of the tools has it.");
    }
    return *this;
  }

 private:
  py::class_<T> class_;
};

}  // namespace

void BindSummaries(py::module_* module) {
  Record<PathQuality>(module, "PathQuality", "Figures that see what an energy cannot.");
  Record<ShapeError>(module, "ShapeError",
                     "How far a shape is from another one in what rigid motion does not change.");
  Record<GeodesicSummary::Level>(
      module, "GeodesicLevel",
      "One level and one number of inner shapes between one pair of poses.");
  Record<GeodesicSummary>(module, "GeodesicSummary",
                          "How a geodesic was solved, and how good it is.")
      .Reports<true, true>();
  Record<SplineSummary>(module, "SplineSummary", "How a spline was made, and how smooth it is.")
      .Reports<true, true>();
  Record<AverageSummary>(module, "AverageSummary", "How good the mean of poses is.")
      .Reports<true, true>();
  Record<ShapeModelSummary>(module, "ShapeModelSummary", "The modes of poses.")
      .Reports<true, true>();
  Record<StandingSummary>(module, "StandingSummary",
                          "How parts of a body that stand were held in the shapes of a path.")
      .Reports<false, true>();
  Record<ExponentialSummary::Step>(module, "ExponentialStep", "A step beyond the path.");
  Record<ExponentialSummary>(module, "ExponentialSummary",
                             "What happened on the way, and how far it can be trusted.")
      .Reports<true, true>();
  Record<CorrectionSummary>(module, "CorrectionSummary", "What a correction did, and what it cost.")
      .Reports<false, true>();
  Record<TransportSummary::Step>(module, "TransportStep", "A segment of the path.");
  Record<TransportSummary>(module, "TransportSummary", "How tangents were carried along a path.")
      .Reports<false, false>();
  Record<TransferSummary::Step>(module, "TransferStep", "One more shape of the target.");
  Record<TransferSummary>(module, "TransferSummary",
                          "How a motion was carried over, and what the target did not take over.")
      .Reports<true, true>();
  Record<PoseTransferSummary>(module, "PoseTransferSummary", "How poses were carried over.")
      .Reports<true, true>();
  Record<DeformationSummary::HandleResult>(module, "HandleResult",
                                           "How far a handle is from having what it asks for.");
  Record<DeformationSummary::Level>(module, "DeformationLevel", "One row of the solve.");
  Record<DeformationSummary>(module, "DeformationSummary",
                             "How a deformation was solved, and how good it is.")
      .Reports<true, true>();
  Record<RepairSummary>(module, "RepairSummary", "What was restored.").Reports<true, true>();
  Record<CorrespondenceSummary::Stage>(module, "CorrespondenceStage",
                                       "Rounds of closest points on one level.");
  Record<CorrespondenceSummary::Doubt>(module, "MarkerDoubt",
                                       "A marker that the others do not predict.");
  Record<CorrespondenceSummary::Candidate>(module, "MapCandidate",
                                           "A map that was found without markers.");
  Record<CorrespondenceSummary::PartInDoubt>(
      module, "PartInDoubt", "A part of the template that may belong elsewhere on the target.");
  Record<CorrespondenceSummary>(module, "CorrespondenceSummary",
                                "How a template was fitted, and how good the fit is.")
      .Reports<true, true>();
  Record<SkinningSummary>(module, "SkinningSummary", "How bones were found, and how good they are.")
      .Reports<true, true>();
  Record<ExploreSummary::Level>(module, "ExploreLevel", "A round of refinement.");
  Record<ExploreSummary>(module, "ExploreSummary", "How a space was made, and how good it is.")
      .Reports<true, true>();
}

}  // namespace shapespace::python
