#include "options.h"

#include <algorithm>

namespace shapespace::python {

void RefuseKeyword(const std::string& name, const std::vector<std::string>& known) {
  std::string all;
  for (const std::string& one : known) all += (all.empty() ? "" : ", ") + one;
  const py::list near = py::module_::import("difflib").attr("get_close_matches")(name, known, 1);
  throw py::type_error(
      "'" + name + "' is no option here" +
      (near.empty() ? "" : "; did you mean '" + py::cast<std::string>(near[0]) + "'") +
      (all.empty() ? "" : "; options are " + all));
}

void RefuseType(const std::string& name, const std::string& type, py::handle value) {
  throw py::type_error(name + ": must be " + type + ", not " +
                       py::cast<std::string>(py::repr(value)));
}

// Names of values. ------------------------------------------------------------------------------

template <>
const Names<Weighting>& NamesOf() {
  static const Names<Weighting> names = {{"area", Weighting::kArea},
                                         {"uniform", Weighting::kUniform}};
  return names;
}
template <>
const Names<Discretization>& NamesOf() {
  static const Names<Discretization> names = {{"midpoint", Discretization::kMidpoint},
                                              {"trapezoid", Discretization::kTrapezoid}};
  return names;
}
template <>
const Names<StiffnessOn>& NamesOf() {
  static const Names<StiffnessOn> names = {{"vertices", StiffnessOn::kVertices},
                                           {"edges", StiffnessOn::kEdges}};
  return names;
}
template <>
const Names<PosePairs>& NamesOf() {
  static const Names<PosePairs> names = {{"consecutive", PosePairs::kConsecutive},
                                         {"all", PosePairs::kAll}};
  return names;
}
template <>
const Names<GeodesicSolver>& NamesOf() {
  static const Names<GeodesicSolver> names = {{"automatic", GeodesicSolver::kAutomatic},
                                              {"lbfgs", GeodesicSolver::kLbfgs},
                                              {"threaded_lbfgs", GeodesicSolver::kThreadedLbfgs},
                                              {"trust_region", GeodesicSolver::kTrustRegion}};
  return names;
}
template <>
const Names<GeodesicSchedule>& NamesOf() {
  static const Names<GeodesicSchedule> names = {{"automatic", GeodesicSchedule::kAutomatic},
                                                {"paper", GeodesicSchedule::kPaper},
                                                {"flat", GeodesicSchedule::kFlat}};
  return names;
}
template <>
const Names<GeodesicStart>& NamesOf() {
  static const Names<GeodesicStart> names = {{"best", GeodesicStart::kBest},
                                             {"blend", GeodesicStart::kBlend},
                                             {"first", GeodesicStart::kFirst},
                                             {"last", GeodesicStart::kLast},
                                             {"rigid", GeodesicStart::kRigid}};
  return names;
}
template <>
const Names<Termination>& NamesOf() {
  static const Names<Termination> names = {{"converged", Termination::kConverged},
                                           {"max_iterations", Termination::kMaxIterations},
                                           {"stalled", Termination::kStalled},
                                           {"cancelled", Termination::kCancelled}};
  return names;
}
template <>
const Names<GeodesicIntegrator>& NamesOf() {
  static const Names<GeodesicIntegrator> names = {
      {"variational", GeodesicIntegrator::kVariational},
      {"runge_kutta_4", GeodesicIntegrator::kRungeKutta4},
      {"first_integral", GeodesicIntegrator::kFirstIntegral}};
  return names;
}
template <>
const Names<StepSolver>& NamesOf() {
  static const Names<StepSolver> names = {{"newton_krylov", StepSolver::kNewtonKrylov},
                                          {"ceres", StepSolver::kCeres}};
  return names;
}
template <>
const Names<FirstIntegralSolver>& NamesOf() {
  static const Names<FirstIntegralSolver> names = {
      {"lbfgs", FirstIntegralSolver::kLbfgs},
      {"levenberg_marquardt", FirstIntegralSolver::kLevenbergMarquardt}};
  return names;
}
template <>
const Names<ExponentialSummary::Ending>& NamesOf() {
  static const Names<ExponentialSummary::Ending> names = {
      {"complete", ExponentialSummary::Ending::kComplete},
      {"degenerate", ExponentialSummary::Ending::kDegenerate},
      {"cancelled", ExponentialSummary::Ending::kCancelled}};
  return names;
}
template <>
const Names<CorrectionMode>& NamesOf() {
  static const Names<CorrectionMode> names = {{"proximal", CorrectionMode::kProximal},
                                              {"paper", CorrectionMode::kPaper}};
  return names;
}
template <>
const Names<TransportConnection>& NamesOf() {
  static const Names<TransportConnection> names = {
      {"levi_civita", TransportConnection::kLeviCivita},
      {"constrained_projection", TransportConnection::kConstrainedProjection}};
  return names;
}
template <>
const Names<TransferMethod>& NamesOf() {
  static const Names<TransferMethod> names = {{"features", TransferMethod::kFeatures},
                                              {"ladder", TransferMethod::kLadder}};
  return names;
}
template <>
const Names<DeformationOptions::Solver>& NamesOf() {
  static const Names<DeformationOptions::Solver> names = {
      {"threaded_lbfgs", DeformationOptions::Solver::kThreadedLbfgs},
      {"trust_region", DeformationOptions::Solver::kTrustRegion}};
  return names;
}
template <>
const Names<GltfPlayback>& NamesOf() {
  static const Names<GltfPlayback> names = {{"there_and_back", GltfPlayback::kThereAndBack},
                                            {"loop", GltfPlayback::kLoop},
                                            {"once", GltfPlayback::kOnce}};
  return names;
}

// Metrics. --------------------------------------------------------------------------------------

MetricOptions PresetMetric(const std::string& preset) {
  if (preset == "isometric") return MetricOptions::Isometric();
  if (preset == "strain") return MetricOptions::Strain();
  if (preset == "rigid") return MetricOptions::Rigid();
  if (preset == "paper") return MetricOptions::Paper();
  throw py::value_error("metric: '" + preset +
                        "' is no preset; there are 'strain', 'isometric', 'rigid' and 'paper'");
}

void Value<MetricOptions>::Set(MetricOptions* value, py::handle given, const std::string& name) {
  if (given.is_none()) return;
  if (py::isinstance<py::str>(given)) {
    *value = PresetMetric(py::cast<std::string>(given));
    return;
  }
  if (!py::isinstance<py::dict>(given)) RefuseType(name, Type(), given);
  const py::dict options = py::reinterpret_borrow<py::dict>(given).attr("copy")();
  if (options.contains("preset")) {
    const py::object preset = options.attr("pop")("preset");
    if (!py::isinstance<py::str>(preset)) RefuseType("preset", "str", preset);
    *value = PresetMetric(py::cast<std::string>(preset));
  }
  python::Set(options, value);
}

template <>
const Fields<MetricOptions>& FieldsOf() {
  using O = MetricOptions;
  static const Fields<O> fields = {
      Row("isometric", &O::isometric,
          "Cost of a change of edge lengths, measured by their squares."),
      Row("strain", &O::strain,
          "Cost of a change of the triangles' logarithmic strains: paths can always go on."),
      Row("rigid", &O::rigid, "Cost of deviation from rigid motion of the whole."),
      Row("lambda_", &O::lambda, "Cost of the motion of vertices; harmless up to 1e-3."),
      Row("bending", &O::bending,
          "Cost of a change of dihedral angles: t^2 / 12 for a shell of thickness t."),
      Row("volume", &O::volume,
          "Cost of a change of the enclosed volume, closed meshes only; start from 0.3."),
      Row("weights", &O::weights,
          "Weights of edges and triangles: by the surface around them, or 1 as in the paper."),
      Row("discretization", &O::discretization,
          "How the metric is integrated along a segment of a path."),
      Row("stretching_stiffness", &O::stretching_stiffness,
          "Positive factors on the cost of stretching, one number for each vertex or edge, as "
          "`stiffness_on` says. None: 1 everywhere."),
      Row("bending_stiffness", &O::bending_stiffness,
          "Positive factors on the cost of bending, likewise."),
      Row("stiffness_on", &O::stiffness_on,
          "What the numbers of both stiffnesses belong to: the vertices, or the rows of `edges`."),
  };
  return fields;
}

// Tables. ---------------------------------------------------------------------------------------

namespace {

// The rows of a struct that is a part of another one, or its base, as rows of that one.
template <typename Options, typename Part, typename Reach>
void AddRows(const Fields<Part>& rows, Reach reach, const std::vector<std::string>& but,
             Fields<Options>* fields) {
  for (const Field<Part>& row : rows) {
    if (std::find(but.begin(), but.end(), row.name) != but.end()) continue;
    fields->push_back(
        {row.name, row.type, row.doc,
         [row, reach](Options* options, py::handle given) { row.set(&reach(*options), given); },
         [row, reach](const Options& options) {
           return row.get(reach(const_cast<Options&>(options)));
         }});
  }
}

}  // namespace

template <>
const Fields<GeodesicOptions>& FieldsOf() {
  using O = GeodesicOptions;
  static const Fields<O> fields = {
      Row("metric", &O::metric, "What motions cost: a preset's name, or options of the metric."),
      Row("shapes", &O::shapes, "Shapes inserted between neighbouring poses, at least 1."),
      Row("tolerance", &O::tolerance,
          "A level is finished when an iteration lowers the energy by less than this share of it."),
      Row("max_iterations", &O::max_iterations,
          "Iterations that a level may take; reaching them is reported as not converged."),
      Row("solver", &O::solver, "The optimiser of each level."),
      Row("schedule", &O::schedule, "In which order resolutions in space and time are solved."),
      Row("start", &O::start, "Where the one inner shape of the first solve starts."),
      Row("coarsest", &O::coarsest, "Triangles of the coarsest level of the hierarchy."),
      Row("memory_limit", &O::memory_limit,
          "Bytes that the solve may take; an estimate above it is refused at once."),
      Row("assess", &O::assess,
          "Whether the path is measured for the summary's quality and intersections, which takes "
          "up to a fifth of the time."),
  };
  return fields;
}

template <>
const Fields<LogarithmOptions>& FieldsOf() {
  static const Fields<LogarithmOptions> fields = [] {
    Fields<LogarithmOptions> rows;
    AddRows<LogarithmOptions>(
        FieldsOf<GeodesicOptions>(),
        [](LogarithmOptions& options) -> GeodesicOptions& { return options; }, {"metric", "assess"},
        &rows);
    return rows;
  }();
  return fields;
}

template <>
const Fields<ExponentialOptions>& FieldsOf() {
  using O = ExponentialOptions;
  static const Fields<O> fields = {
      Row("integrator", &O::integrator,
          "The discrete Euler-Lagrange equation (order 2), Runge-Kutta (order 4), or the paper's "
          "first integral, which does not converge."),
      Row("solver", &O::solver, "What solves a step of the variational integrator."),
      Row("first_integral_solver", &O::first_integral_solver,
          "What solves a step of the first integral."),
      Row("tolerance", &O::tolerance,
          "A step is solved when its residual is this share of the step itself."),
      Row("max_iterations", &O::max_iterations, "Of Newton's method in a step, or of Ceres."),
  };
  return fields;
}

template <>
const Fields<CorrectionOptions>& FieldsOf() {
  using O = CorrectionOptions;
  static const Fields<O> fields = {
      Row("mode", &O::mode,
          "Whether the distance from the given shapes has a cost; the paper's mode collapses."),
      Row("mu", &O::mu, "Weight of that distance: small values keep lengths, large ones motion."),
      Row("tolerance", &O::tolerance,
          "Done when an iteration lowers what is minimised by less than this share of it."),
      Row("max_iterations", &O::max_iterations, "Reaching it is reported as not converged."),
  };
  return fields;
}

template <>
const Fields<TransportOptions>& FieldsOf() {
  using O = TransportOptions;
  static const Fields<O> fields = {
      Row("connection", &O::connection, "The metric's own connection, or the paper's."),
      Row("align", &O::align,
          "Turn each shape onto the next one, and the tangent with it, before a step."),
      Row("tolerance", &O::tolerance,
          "Error of a step's linear systems, as a share of the tangent's norm."),
      Row("max_iterations", &O::max_iterations, "Of the linear solver, a step and tangent."),
      Row("memory_limit", &O::memory_limit,
          "Bytes that the call may take; an estimate above it is refused at once."),
  };
  return fields;
}

template <>
const Fields<LadderOptions>& FieldsOf() {
  using O = LadderOptions;
  static const Fields<O> fields = {
      Row("metric", &O::metric, "Under which the two bodies are compared."),
      Row("rung_shapes", &O::rung_shapes,
          "Shapes between one of the source and the target's that belongs to it; odd."),
      Row("scale", &O::scale, "Compare the bodies in one size."),
      Row("align", &O::align, "Compare the bodies in one orientation."),
      Row("connection", &O::connection, "What carries the source's velocity along a rung."),
      Row("tolerance", &O::tolerance, "Of the geodesics that are the rungs."),
  };
  return fields;
}

template <>
const Fields<TransferOptions>& FieldsOf() {
  using O = TransferOptions;
  static const Fields<O> fields = {
      Row("method", &O::method,
          "Strains and angles change as the source's, or the paper's ladder of geodesics."),
      Row("metric", &O::metric,
          "Of the method 'features': costs of strains, angles and, as `lambda_`, positions."),
      Row("tolerance", &O::tolerance,
          "Of the method 'features': a shape is found when an iteration gains less than this."),
      Row("max_iterations", &O::max_iterations, "Of the method 'features', a shape."),
      Row("hybrids", &O::hybrids, "Make the bodies half way between source and target too."),
      Row("ladder", &O::ladder, "Of the ladder, and of hybrids."),
      Row("memory_limit", &O::memory_limit,
          "Bytes that the transfer may take; an estimate above it is refused at once."),
  };
  return fields;
}

template <>
const Fields<DeformationOptions>& FieldsOf() {
  using O = DeformationOptions;
  static const Fields<O> fields = {
      Row("metric", &O::metric,
          "What the deformation costs: a preset's name, or options that differ from those of "
          "MetricOptions::Deformation of the mesh."),
      Row("shapes", &O::shapes, "Shapes after the first, the deformed one included."),
      Row("balance", &O::balance,
          "Between the metric and soft handles, in (0, 1]: to 0, handles are met; at 1, nothing "
          "moves."),
      Row("tolerance", &O::tolerance,
          "A level is finished when two iterations in a row lower what is minimised by less than "
          "this share of it."),
      Row("max_iterations", &O::max_iterations,
          "Iterations that a level may take; reaching them is reported as not converged."),
      Row("solver", &O::solver, "The optimiser; trust_region is slow beyond a thousand vertices."),
      Row("coarsest", &O::coarsest, "Triangles of the coarsest level of the hierarchy."),
      Row("memory_limit", &O::memory_limit,
          "Bytes that the solve may take; an estimate above it is refused at once."),
  };
  return fields;
}

template <>
const Fields<RepairOptions>& FieldsOf() {
  static const Fields<RepairOptions> fields = [] {
    Fields<RepairOptions> rows;
    AddRows<RepairOptions>(
        FieldsOf<DeformationOptions>(),
        [](RepairOptions& options) -> DeformationOptions& { return options.deformation; }, {},
        &rows);
    return rows;
  }();
  return fields;
}

template <>
const Fields<CorrespondenceOptions>& FieldsOf() {
  using O = CorrespondenceOptions;
  static const Fields<O> fields = {
      Row("drop_doubtful", &O::drop_doubtful, "Leave out markers that contradict the others."),
      Row("proportions", &O::proportions,
          "Over which length, as a share of the root of the area, the two bodies' proportions may "
          "differ from place to place."),
      Row("bending", &O::bending,
          "Stiffness of the fitted template: more keeps it from following detail that it does not "
          "have, less lets it fold."),
      Row("tolerance", &O::tolerance,
          "The last rounds end when vertices move by less than this share of the root of the "
          "area."),
      Row("max_iterations", &O::max_iterations, "Rounds that these last may take."),
      Row("coarsest", &O::coarsest, "Triangles of the coarsest level of the hierarchy."),
      Row("memory_limit", &O::memory_limit,
          "Bytes that the fit may take; an estimate above it is refused at once."),
  };
  return fields;
}

template <>
const Fields<EmbeddingOptions>& FieldsOf() {
  using O = EmbeddingOptions;
  static const Fields<O> fields = {
      Row("tolerance", &O::tolerance,
          "Ends when an iteration lowers the stress by less than this share of it."),
      Row("max_iterations", &O::max_iterations, "Iterations that it may take."),
  };
  return fields;
}

template <>
const Fields<ExploreOptions>& FieldsOf() {
  using O = ExploreOptions;
  static const Fields<O> fields = {
      Row("geodesic", &O::geodesic, "Of every geodesic; `shapes` must be odd."),
      Row("resolution", &O::resolution,
          "Triangles, at most, of the level on which distances are measured; 0: the mesh itself."),
      Row("threshold", &O::threshold,
          "A straight line between two nodes that is longer than the geodesic by more than this "
          "share is replaced by two."),
      Row("depth", &O::depth, "How often a triangle of the plane may be split, at most."),
      Row("embedding", &O::embedding, "Of the places on the plane."),
      Row("records", &O::records,
          "A folder in which finished geodesics are kept, to go on from if a run is ended; empty: "
          "nothing is kept."),
  };
  return fields;
}

template <>
const Fields<FilmStripOptions>& FieldsOf() {
  using O = FilmStripOptions;
  static const Fields<O> fields = {
      Row("frame_width", &O::frame_width, "Longer side of the largest shape's cell, in pixels."),
      Row("max_frames", &O::max_frames, "Longer paths are subsampled, evenly."),
      Row("samples", &O::samples, "Per pixel and axis."),
      Row("view", &O::view, "Where the eye is, seen from the body; zero: chosen."),
      Row("up", &O::up, "What points up in the picture; zero: +y or +z."),
      Row("values", &O::values,
          "Values of every shape's vertices (.01 is one per cent), shown as colour."),
      Row("legend", &O::legend, "What the values or groups are."),
      Row("groups", &O::groups, "Group of each vertex, shown as a colour each; negative: none."),
      Row("marks", &O::marks, "Mark of each vertex: 1 dark, 2 red, else none."),
      Row("labels", &O::labels, "Written under each shape."),
      Row("title", &O::title, "A line above all."),
  };
  return fields;
}

template <>
const Fields<GltfOptions>& FieldsOf() {
  using O = GltfOptions;
  static const Fields<O> fields = {
      Row("duration", &O::duration, "Seconds, holds included."),
      Row("fps", &O::fps, "Shapes of the path a second, instead of the duration; 0: off."),
      Row("playback", &O::playback, "There and back, around, or once."),
      Row("ease", &O::ease, "Slow at both ends."),
      Row("unit", &O::unit, "Metres in one of the shapes' units; .001: millimetres."),
      Row("colour_by_deviation", &O::colour_by_deviation,
          "Colour vertices by how far edges there are from their first lengths."),
      Row("groups", &O::groups, "Group of each vertex: a colour each; negative: none."),
      Row("allow_outside_files", &O::allow_outside_files,
          "Take material libraries and textures from outside of the folder of the file that names "
          "them too: for files that are trusted."),
  };
  return fields;
}

namespace {

template <typename Options>
py::list Describe() {
  py::list rows;
  const Options defaults;
  for (const Field<Options>& field : FieldsOf<Options>()) {
    rows.append(py::make_tuple(field.name, field.type, field.get(defaults), field.doc));
  }
  return rows;
}

}  // namespace

py::list DescribeOptions(const std::string& name) {
  static const std::vector<std::pair<std::string, py::list (*)()>> tables = {
      {"MetricOptions", Describe<MetricOptions>},
      {"GeodesicOptions", Describe<GeodesicOptions>},
      {"LogarithmOptions", Describe<LogarithmOptions>},
      {"ExponentialOptions", Describe<ExponentialOptions>},
      {"CorrectionOptions", Describe<CorrectionOptions>},
      {"TransportOptions", Describe<TransportOptions>},
      {"LadderOptions", Describe<LadderOptions>},
      {"TransferOptions", Describe<TransferOptions>},
      {"DeformationOptions", Describe<DeformationOptions>},
      {"RepairOptions", Describe<RepairOptions>},
      {"CorrespondenceOptions", Describe<CorrespondenceOptions>},
      {"EmbeddingOptions", Describe<EmbeddingOptions>},
      {"ExploreOptions", Describe<ExploreOptions>},
      {"FilmStripOptions", Describe<FilmStripOptions>},
      {"GltfOptions", Describe<GltfOptions>},
  };
  for (const auto& [known, describe] : tables) {
    if (known == name) return describe();
  }
  throw py::key_error(name);
}

}  // namespace shapespace::python
