#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/shape_error.h>

#include "bind.h"
#include "options.h"

// What solvers say of what they did, as objects with the attributes that C++ has.

namespace shapespace::python {
namespace {

template <typename T>
py::object ToPython(const T& value) {
  if constexpr (std::is_enum_v<T>) {
    return py::str(NameOf(value));
  } else {
    return py::cast(value);
  }
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
    class_.attr("_fields") = py::list();
  }

  template <typename Member, typename Base>
  Record& Read(const char* name, Member Base::*member) {
    return Property(name, [member](const T& self) { return ToPython(self.*member); });
  }

  template <typename Getter>
  Record& Property(const char* name, Getter&& getter) {
    class_.def_property_readonly(name, std::forward<Getter>(getter));
    class_.attr("_fields").attr("append")(name);
    return *this;
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
  Record<PathQuality>(module, "PathQuality", "Figures that see what an energy cannot.")
      .Read("inner_shapes", &PathQuality::inner_shapes)
      .Read("edge_rms", &PathQuality::edge_rms)
      .Read("edge_p99", &PathQuality::edge_p99)
      .Read("edge_max", &PathQuality::edge_max)
      .Read("first_rms", &PathQuality::first_rms)
      .Read("first_p99", &PathQuality::first_p99)
      .Read("first_max", &PathQuality::first_max)
      .Read("roughness", &PathQuality::roughness)
      .Read("folds", &PathQuality::folds)
      .Read("speed_max", &PathQuality::speed_max);

  Record<ShapeError>(module, "ShapeError",
                     "How far a shape is from another one in what rigid motion does not change.")
      .Read("edge_rms", &ShapeError::edge_rms)
      .Read("edge_p99", &ShapeError::edge_p99)
      .Read("edge_max", &ShapeError::edge_max)
      .Read("volume", &ShapeError::volume)
      .Read("inverted_hinges", &ShapeError::inverted_hinges);

  Record<GeodesicSummary::Level>(
      module, "GeodesicLevel",
      "One level and one number of inner shapes between one pair of poses.")
      .Read("piece", &GeodesicSummary::Level::piece)
      .Read("vertices", &GeodesicSummary::Level::vertices)
      .Read("shapes", &GeodesicSummary::Level::shapes)
      .Read("start", &GeodesicSummary::Level::start)
      .Read("solver", &GeodesicSummary::Level::solver)
      .Read("termination", &GeodesicSummary::Level::termination)
      .Read("iterations", &GeodesicSummary::Level::iterations)
      .Read("evaluations", &GeodesicSummary::Level::evaluations)
      .Read("initial_energy", &GeodesicSummary::Level::initial_energy)
      .Read("energy", &GeodesicSummary::Level::energy)
      .Read("remaining", &GeodesicSummary::Level::remaining)
      .Read("kept", &GeodesicSummary::Level::kept)
      .Read("seconds", &GeodesicSummary::Level::seconds);

  Record<GeodesicSummary>(module, "GeodesicSummary",
                          "How a geodesic was solved, and how good it is.")
      .Read("termination", &GeodesicSummary::termination)
      .Read("vertices", &GeodesicSummary::vertices)
      .Read("triangles", &GeodesicSummary::triangles)
      .Read("edges", &GeodesicSummary::edges)
      .Read("hinges", &GeodesicSummary::hinges)
      .Read("poses", &GeodesicSummary::poses)
      .Read("shapes", &GeodesicSummary::shapes)
      .Read("metric", &GeodesicSummary::metric)
      .Read("unit", &GeodesicSummary::unit)
      .Read("energy", &GeodesicSummary::energy)
      .Read("lower_bound", &GeodesicSummary::lower_bound)
      .Read("quality", &GeodesicSummary::quality)
      .Read("intersections", &GeodesicSummary::intersections)
      .Read("hierarchy", &GeodesicSummary::hierarchy)
      .Read("hierarchy_stopped_early", &GeodesicSummary::hierarchy_stopped_early)
      .Read("levels", &GeodesicSummary::levels)
      .Read("warnings", &GeodesicSummary::warnings)
      .Read("estimated_bytes", &GeodesicSummary::estimated_bytes)
      .Read("freeze_seconds", &GeodesicSummary::freeze_seconds)
      .Read("hierarchy_seconds", &GeodesicSummary::hierarchy_seconds)
      .Read("factor_seconds", &GeodesicSummary::factor_seconds)
      .Read("solve_seconds", &GeodesicSummary::solve_seconds)
      .Read("total_seconds", &GeodesicSummary::total_seconds)
      .Read("factor_nonzeros", &GeodesicSummary::factor_nonzeros)
      .Read("threads", &GeodesicSummary::threads)
      .Property("ratio", &GeodesicSummary::Ratio)
      .Property("parts",
                [](const GeodesicSummary& summary) { return py::dict(py::cast(summary.parts)); })
      .Property("converged",
                [](const GeodesicSummary& s) { return s.termination == Termination::kConverged; })
      .Reports<true, true>();

  Record<ExponentialSummary::Step>(module, "ExponentialStep", "A step beyond the path.")
      .Read("t", &ExponentialSummary::Step::t)
      .Read("converged", &ExponentialSummary::Step::converged)
      .Read("vertices", &ExponentialSummary::Step::vertices)
      .Read("increments", &ExponentialSummary::Step::increments)
      .Read("iterations", &ExponentialSummary::Step::iterations)
      .Read("krylov_iterations", &ExponentialSummary::Step::krylov_iterations)
      .Read("residual", &ExponentialSummary::Step::residual)
      .Read("energy", &ExponentialSummary::Step::energy)
      .Read("momentum_drift", &ExponentialSummary::Step::momentum_drift)
      .Read("edge_rms", &ExponentialSummary::Step::edge_rms)
      .Read("edge_max", &ExponentialSummary::Step::edge_max)
      .Read("inverted", &ExponentialSummary::Step::inverted)
      .Read("seconds", &ExponentialSummary::Step::seconds);

  Record<ExponentialSummary>(module, "ExponentialSummary",
                             "What happened on the way, and how far it can be trusted.")
      .Read("ending", &ExponentialSummary::ending)
      .Read("stopped", &ExponentialSummary::stopped)
      .Read("integrator", &ExponentialSummary::integrator)
      .Read("vertices", &ExponentialSummary::vertices)
      .Read("requested_steps", &ExponentialSummary::requested_steps)
      .Read("metric", &ExponentialSummary::metric)
      .Read("steps", &ExponentialSummary::steps)
      .Read("warnings", &ExponentialSummary::warnings)
      .Read("total_seconds", &ExponentialSummary::total_seconds)
      .Read("factor_seconds", &ExponentialSummary::factor_seconds)
      .Read("factorisations", &ExponentialSummary::factorisations)
      .Property("converged", &ExponentialSummary::Converged)
      .Reports<true, true>();

  Record<CorrectionSummary>(module, "CorrectionSummary", "What a correction did, and what it cost.")
      .Read("mode", &CorrectionSummary::mode)
      .Read("mu", &CorrectionSummary::mu)
      .Read("vertices", &CorrectionSummary::vertices)
      .Read("shapes", &CorrectionSummary::shapes)
      .Read("termination", &CorrectionSummary::termination)
      .Read("converged", &CorrectionSummary::converged)
      .Read("iterations", &CorrectionSummary::iterations)
      .Read("evaluations", &CorrectionSummary::evaluations)
      .Read("initial_energy", &CorrectionSummary::initial_energy)
      .Read("energy", &CorrectionSummary::energy)
      .Read("initial_quality", &CorrectionSummary::initial_quality)
      .Read("quality", &CorrectionSummary::quality)
      .Read("distance", &CorrectionSummary::distance)
      .Read("deformation_left", &CorrectionSummary::deformation_left)
      .Read("warnings", &CorrectionSummary::warnings)
      .Read("total_seconds", &CorrectionSummary::total_seconds)
      .Reports<false, true>();

  Record<TransportSummary::Step>(module, "TransportStep", "A segment of the path.")
      .Read("krylov_iterations", &TransportSummary::Step::krylov_iterations)
      .Read("residual", &TransportSummary::Step::residual)
      .Read("seconds", &TransportSummary::Step::seconds);

  Record<TransportSummary>(module, "TransportSummary", "How tangents were carried along a path.")
      .Read("converged", &TransportSummary::converged)
      .Read("metric", &TransportSummary::metric)
      .Read("steps", &TransportSummary::steps)
      .Read("first_norm", &TransportSummary::first_norm)
      .Read("last_norm", &TransportSummary::last_norm)
      .Read("estimated_bytes", &TransportSummary::estimated_bytes)
      .Read("total_seconds", &TransportSummary::total_seconds)
      .Reports<false, false>();

  Record<TransferSummary::Step>(module, "TransferStep", "One more shape of the target.")
      .Read("converged", &TransferSummary::Step::converged)
      .Read("iterations", &TransferSummary::Step::iterations)
      .Read("on_mesh", &TransferSummary::Step::on_mesh)
      .Read("ratio", &TransferSummary::Step::ratio)
      .Read("norm_change", &TransferSummary::Step::norm_change)
      .Read("warnings", &TransferSummary::Step::warnings)
      .Read("seconds", &TransferSummary::Step::seconds);

  Record<TransferSummary>(module, "TransferSummary",
                          "How a motion was carried over, and what the target did not take over.")
      .Read("method", &TransferSummary::method)
      .Read("vertices", &TransferSummary::vertices)
      .Read("metric", &TransferSummary::metric)
      .Read("scale", &TransferSummary::scale)
      .Read("steps", &TransferSummary::steps)
      .Read("strain_rms", &TransferSummary::strain_rms)
      .Read("strain_max", &TransferSummary::strain_max)
      .Read("angle_rms", &TransferSummary::angle_rms)
      .Read("cancelled", &TransferSummary::cancelled)
      .Read("warnings", &TransferSummary::warnings)
      .Read("estimated_bytes", &TransferSummary::estimated_bytes)
      .Read("total_seconds", &TransferSummary::total_seconds)
      .Property("converged", &TransferSummary::Converged)
      .Reports<true, true>();

  Record<PoseTransferSummary>(module, "PoseTransferSummary", "How poses were carried over.")
      .Read("geodesics", &PoseTransferSummary::geodesics)
      .Read("transfers", &PoseTransferSummary::transfers)
      .Read("cancelled", &PoseTransferSummary::cancelled)
      .Property("converged", &PoseTransferSummary::Converged)
      .Property("warnings", &PoseTransferSummary::Warnings)
      .Reports<true, true>();

  Record<DeformationSummary::HandleResult>(module, "HandleResult",
                                           "How far a handle is from having what it asks for.")
      .Read("name", &DeformationSummary::HandleResult::name)
      .Read("vertices", &DeformationSummary::HandleResult::vertices)
      .Read("hard", &DeformationSummary::HandleResult::hard)
      .Read("residual_rms", &DeformationSummary::HandleResult::residual_rms)
      .Read("residual_max", &DeformationSummary::HandleResult::residual_max);

  Record<DeformationSummary::Level>(module, "DeformationLevel", "One row of the solve.")
      .Read("vertices", &DeformationSummary::Level::vertices)
      .Read("shapes", &DeformationSummary::Level::shapes)
      .Read("start", &DeformationSummary::Level::start)
      .Read("termination", &DeformationSummary::Level::termination)
      .Read("iterations", &DeformationSummary::Level::iterations)
      .Read("evaluations", &DeformationSummary::Level::evaluations)
      .Read("initial_value", &DeformationSummary::Level::initial_value)
      .Read("value", &DeformationSummary::Level::value)
      .Read("seconds", &DeformationSummary::Level::seconds);

  Record<DeformationSummary>(module, "DeformationSummary",
                             "How a deformation was solved, and how good it is.")
      .Read("termination", &DeformationSummary::termination)
      .Read("vertices", &DeformationSummary::vertices)
      .Read("triangles", &DeformationSummary::triangles)
      .Read("shapes", &DeformationSummary::shapes)
      .Read("metric", &DeformationSummary::metric)
      .Read("unit", &DeformationSummary::unit)
      .Read("balance", &DeformationSummary::balance)
      .Read("energy", &DeformationSummary::energy)
      .Read("error", &DeformationSummary::error)
      .Read("handles", &DeformationSummary::handles)
      .Read("free_components", &DeformationSummary::free_components)
      .Read("levels", &DeformationSummary::levels)
      .Read("hierarchy", &DeformationSummary::hierarchy)
      .Read("warm", &DeformationSummary::warm)
      .Read("warnings", &DeformationSummary::warnings)
      .Read("estimated_bytes", &DeformationSummary::estimated_bytes)
      .Read("hierarchy_seconds", &DeformationSummary::hierarchy_seconds)
      .Read("factor_seconds", &DeformationSummary::factor_seconds)
      .Read("solve_seconds", &DeformationSummary::solve_seconds)
      .Read("total_seconds", &DeformationSummary::total_seconds)
      .Read("threads", &DeformationSummary::threads)
      .Property("converged", &DeformationSummary::Converged)
      .Reports<true, true>();

  Record<RepairSummary>(module, "RepairSummary", "What was restored.")
      .Read("deformation", &RepairSummary::deformation)
      .Read("before", &RepairSummary::before)
      .Read("after", &RepairSummary::after)
      .Read("moved", &RepairSummary::moved)
      .Property("converged", &RepairSummary::Converged)
      .Reports<true, true>();

  Record<CorrespondenceSummary::Stage>(module, "CorrespondenceStage",
                                       "Rounds of closest points on one level.")
      .Read("vertices", &CorrespondenceSummary::Stage::vertices)
      .Read("name", &CorrespondenceSummary::Stage::name)
      .Read("weight", &CorrespondenceSummary::Stage::weight)
      .Read("rounds", &CorrespondenceSummary::Stage::rounds)
      .Read("distance", &CorrespondenceSummary::Stage::distance)
      .Read("motion", &CorrespondenceSummary::Stage::motion)
      .Read("seconds", &CorrespondenceSummary::Stage::seconds);

  Record<CorrespondenceSummary::Doubt>(module, "MarkerDoubt",
                                       "A marker that the others do not predict.")
      .Read("marker", &CorrespondenceSummary::Doubt::marker)
      .Read("off", &CorrespondenceSummary::Doubt::off)
      .Read("expected", &CorrespondenceSummary::Doubt::expected)
      .Read("swapped", &CorrespondenceSummary::Doubt::swapped);

  Record<CorrespondenceSummary>(module, "CorrespondenceSummary",
                                "How a template was fitted, and how good the fit is.")
      .Read("converged", &CorrespondenceSummary::converged)
      .Read("cancelled", &CorrespondenceSummary::cancelled)
      .Read("template_vertices", &CorrespondenceSummary::template_vertices)
      .Read("template_triangles", &CorrespondenceSummary::template_triangles)
      .Read("target_vertices", &CorrespondenceSummary::target_vertices)
      .Read("target_triangles", &CorrespondenceSummary::target_triangles)
      .Read("markers", &CorrespondenceSummary::markers)
      .Read("doubtful", &CorrespondenceSummary::doubtful)
      .Read("scale", &CorrespondenceSummary::scale)
      .Read("stages", &CorrespondenceSummary::stages)
      .Read("distance_rms", &CorrespondenceSummary::distance_rms)
      .Read("distance_max", &CorrespondenceSummary::distance_max)
      .Read("round_trip_mean", &CorrespondenceSummary::round_trip_mean)
      .Read("round_trip_p95", &CorrespondenceSummary::round_trip_p95)
      .Read("turned", &CorrespondenceSummary::turned)
      .Read("uncovered", &CorrespondenceSummary::uncovered)
      .Read("warnings", &CorrespondenceSummary::warnings)
      .Read("estimated_bytes", &CorrespondenceSummary::estimated_bytes)
      .Read("total_seconds", &CorrespondenceSummary::total_seconds)
      .Read("marker_seconds", &CorrespondenceSummary::marker_seconds)
      .Read("hierarchy_seconds", &CorrespondenceSummary::hierarchy_seconds)
      .Read("fit_seconds", &CorrespondenceSummary::fit_seconds)
      .Read("unfold_seconds", &CorrespondenceSummary::unfold_seconds)
      .Read("map_seconds", &CorrespondenceSummary::map_seconds)
      .Reports<true, true>();

  Record<ExploreSummary::Level>(module, "ExploreLevel", "A round of refinement.")
      .Read("cells", &ExploreSummary::Level::cells)
      .Read("edges", &ExploreSummary::Level::edges)
      .Read("marked", &ExploreSummary::Level::marked)
      .Read("greatest_excess", &ExploreSummary::Level::greatest_excess)
      .Read("new_nodes", &ExploreSummary::Level::new_nodes)
      .Read("seconds", &ExploreSummary::Level::seconds);

  Record<ExploreSummary>(module, "ExploreSummary", "How a space was made, and how good it is.")
      .Read("vertices", &ExploreSummary::vertices)
      .Read("triangles", &ExploreSummary::triangles)
      .Read("distance_vertices", &ExploreSummary::distance_vertices)
      .Read("poses", &ExploreSummary::poses)
      .Read("nodes", &ExploreSummary::nodes)
      .Read("cells", &ExploreSummary::cells)
      .Read("metric", &ExploreSummary::metric)
      .Read("unit", &ExploreSummary::unit)
      .Read("threshold", &ExploreSummary::threshold)
      .Read("solved", &ExploreSummary::solved)
      .Read("found", &ExploreSummary::found)
      .Read("damaged", &ExploreSummary::damaged)
      .Read("not_converged", &ExploreSummary::not_converged)
      .Read("stress", &ExploreSummary::stress)
      .Read("stress_iterations", &ExploreSummary::stress_iterations)
      .Read("embedded", &ExploreSummary::embedded)
      .Read("levels", &ExploreSummary::levels)
      .Read("edges_not_measured", &ExploreSummary::edges_not_measured)
      .Read("warnings", &ExploreSummary::warnings)
      .Read("distance_seconds", &ExploreSummary::distance_seconds)
      .Read("embedding_seconds", &ExploreSummary::embedding_seconds)
      .Read("refinement_seconds", &ExploreSummary::refinement_seconds)
      .Read("total_seconds", &ExploreSummary::total_seconds)
      .Read("threads", &ExploreSummary::threads)
      .Read("processes", &ExploreSummary::processes)
      .Property("converged", &ExploreSummary::Converged)
      .Reports<true, true>();
}

}  // namespace shapespace::python
