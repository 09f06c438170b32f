#include "options.h"

#include "bind.h"

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

bool IsTruthValue(py::handle value) {
  return py::isinstance<py::bool_>(value) ||
         py::isinstance(value, py::module_::import("numpy").attr("bool_"));
}

bool IsWholeFloat(py::handle value) {
  return py::hasattr(value, "is_integer") && py::cast<bool>(value.attr("is_integer")());
}

namespace {

// A preset by its name. "deformation" is refused, because it depends on the mesh; functions that
// deform have it as their default.
MetricOptions PresetMetric(const std::string& name) {
  const std::optional<MetricOptions> preset = internal::MetricPreset(name);
  if (preset) return *preset;
  throw py::value_error("metric: '" + name +
                        "' is no preset; there are 'strain', 'isometric', 'rigid' and 'paper'");
}

}  // namespace

void Value<MetricOptions>::Set(MetricOptions* value, py::handle given, const std::string& name) {
  if (given.is_none()) return;
  if (py::isinstance<py::str>(given)) {
    *value = PresetMetric(py::cast<std::string>(given));
    return;
  }
  if (py::isinstance<FrozenMetric>(given)) {
    *value = py::cast<const FrozenMetric&>(given).metric->options;
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

void Value<std::optional<Obstacle>>::Set(std::optional<Obstacle>* value, py::handle given,
                                         const std::string& name) {
  value->reset();
  if (given.is_none()) return;
  if (py::isinstance<Poses>(given)) {
    const auto& poses = py::cast<const Poses&>(given);
    *value = {poses.connectivity, poses.shapes.front()};
    return;
  }
  if (!py::isinstance<py::sequence>(given) || py::len(given) != 2) {
    RefuseType(name, Type(), given);
  }
  const Poses poses = MakePoses({ToShape(given[py::int_(0)], name + "[0]")}, given[py::int_(1)]);
  *value = {poses.connectivity, poses.shapes.front()};
}

void Value<std::vector<FeatureTerm>>::Set(std::vector<FeatureTerm>* value, py::handle given,
                                          const std::string& name) {
  value->clear();
  if (given.is_none()) return;
  if (!py::isinstance<py::dict>(given)) RefuseType(name, Type(), given);
  for (const auto& [key, coefficient] : py::reinterpret_borrow<py::dict>(given)) {
    FeatureTerm term;
    Value<std::string>::Set(&term.name, key, name);
    Value<double>::Set(&term.coefficient, coefficient, name + "['" + term.name + "']");
    value->push_back(term);
  }
}

py::object Value<std::vector<FeatureTerm>>::Get(const std::vector<FeatureTerm>& value) {
  if (value.empty()) return py::none();
  py::object terms = py::dict();
  for (const FeatureTerm& term : value) terms[term.name.c_str()] = term.coefficient;
  return terms;
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
      {"SkinningOptions", Describe<SkinningOptions>},
      {"SplineOptions", Describe<SplineOptions>},
      {"AverageOptions", Describe<AverageOptions>},
      {"ShapeModelOptions", Describe<ShapeModelOptions>},
      {"FilmStripOptions", Describe<FilmStripOptions>},
      {"GltfOptions", Describe<GltfOptions>},
  };
  for (const auto& [known, describe] : tables) {
    if (known == name) return describe();
  }
  throw py::key_error(name);
}

}  // namespace shapespace::python
