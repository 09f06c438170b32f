#ifndef SHAPESPACE_PYTHON_OPTIONS_H_
#define SHAPESPACE_PYTHON_OPTIONS_H_

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <shapespace/correspondence/internal/option_fields.h>
#include <shapespace/deformation/internal/option_fields.h>
#include <shapespace/exploration/internal/option_fields.h>
#include <shapespace/exponential/internal/option_fields.h>
#include <shapespace/geodesic/internal/option_fields.h>
#include <shapespace/metric/internal/option_fields.h>
#include <shapespace/output/internal/option_fields.h>
#include <shapespace/skinning/internal/option_fields.h>
#include <shapespace/spline/internal/option_fields.h>
#include <shapespace/statistics/internal/option_fields.h>
#include <shapespace/transfer/internal/option_fields.h>

#include "arrays.h"

// Options as keyword arguments. Names, values, defaults and meanings are those of the library
// (base/internal/fields.h).

namespace shapespace::python {

/// A field of a struct of options.
template <typename Options>
struct Field {
  std::string name;  ///< the C++ name; `lambda_` for `lambda`, which Python keeps for itself
  std::string type;  ///< as numpydoc has it
  std::string doc;
  std::function<void(Options*, py::handle)> set;
  std::function<py::object(const Options&)> get;
};

template <typename Options>
using Fields = std::vector<Field<Options>>;

/// All fields of a struct.
template <typename Options>
const Fields<Options>& FieldsOf();

[[noreturn]] void RefuseKeyword(const std::string& name, const std::vector<std::string>& known);
[[noreturn]] void RefuseType(const std::string& name, const std::string& type, py::handle value);

/// Whether it is Python's or numpy's True or False.
bool IsTruthValue(py::handle value);

/// Whether it is a float, Python's or numpy's, that is a whole number.
bool IsWholeFloat(py::handle value);

/// Sets the fields that `keywords` name. \throw py::type_error naming a keyword that is none or a
/// value of another type; py::value_error. Messages list `others`, which the caller takes, too.
template <typename Options>
void Set(const py::dict& keywords, Options* options, const std::vector<std::string>& others = {}) {
  for (const auto& [key, value] : keywords) {
    const auto name = py::cast<std::string>(key);
    const Fields<Options>& fields = FieldsOf<Options>();
    bool found = false;
    for (const Field<Options>& field : fields) {
      if (field.name != name) continue;
      field.set(options, value);
      found = true;
    }
    if (found) continue;
    std::vector<std::string> known = others;
    for (const Field<Options>& field : fields) known.push_back(field.name);
    RefuseKeyword(name, known);
  }
}

/// The fields of `options`, by name.
template <typename Options>
py::dict Get(const Options& options) {
  py::dict values;
  for (const Field<Options>& field : FieldsOf<Options>()) {
    values[field.name.c_str()] = field.get(options);
  }
  return values;
}

/// How a field of this type is converted from and to Python. A struct of options is a dict in
/// Python; fields that the dict does not have keep their values, and None changes no field.
template <typename T, typename = void>
struct Value {
  static std::string Type() { return "dict"; }
  static void Set(T* value, py::handle given, const std::string& name) {
    if (given.is_none()) return;
    if (!py::isinstance<py::dict>(given)) RefuseType(name, Type(), given);
    python::Set(py::reinterpret_borrow<py::dict>(given), value);
  }
  static py::object Get(const T& value) { return python::Get(value); }
};

/// Numbers, truth values, names.
template <typename T>
struct SimpleValue {
  static void Set(T* value, py::handle given, const std::string& name) {
    // Truth values are integers to Python, and would be taken for numbers.
    const bool truth = IsTruthValue(given);
    if (truth != std::is_same_v<T, bool>) RefuseType(name, Value<T>::Type(), given);
    py::object plain = py::reinterpret_borrow<py::object>(given);
    if (std::is_same_v<T, std::string> && py::hasattr(given, "__fspath__")) {
      plain = given.attr("__fspath__")();
    } else if (std::is_same_v<T, int> && IsWholeFloat(given)) {
      plain = py::int_(plain);
    }
    try {
      *value = py::cast<T>(plain);
    } catch (const py::cast_error&) {
      RefuseType(name, Value<T>::Type(), given);
    }
  }
  static py::object Get(const T& value) { return py::cast(value); }
};
template <>
struct Value<int> : SimpleValue<int> {
  static std::string Type() { return "int"; }
};
template <>
struct Value<double> : SimpleValue<double> {
  static std::string Type() { return "float"; }
};
template <>
struct Value<bool> : SimpleValue<bool> {
  static std::string Type() { return "bool"; }
};
/// A number that may be left out: None.
template <>
struct Value<std::optional<double>> {
  static std::string Type() { return Value<double>::Type(); }
  static void Set(std::optional<double>* value, py::handle given, const std::string& name) {
    value->reset();
    if (!given.is_none()) Value<double>::Set(&value->emplace(), given, name);
  }
  static py::object Get(const std::optional<double>& value) { return py::cast(value); }
};
template <>
struct Value<std::string> : SimpleValue<std::string> {
  static std::string Type() { return "str"; }
};
template <>
struct Value<std::vector<std::string>> : SimpleValue<std::vector<std::string>> {
  static std::string Type() { return "list of str"; }
};

template <typename T>
struct Value<T, std::enable_if_t<std::is_enum_v<T>>> {
  static std::string Type() { return "{" + internal::ListWords<T>("'") + "}"; }
  static void Set(T* value, py::handle given, const std::string& name) {
    if (!py::isinstance<py::str>(given)) RefuseType(name, Type(), given);
    const auto text = py::cast<std::string>(given);
    const std::optional<T> one = internal::FromWord<T>(text);
    if (!one) throw py::value_error(name + ": must be one of " + Type() + ", not '" + text + "'");
    *value = *one;
  }
  static py::object Get(const T& value) { return py::str(internal::WordOf(value)); }
};

template <>
struct Value<Eigen::Vector3d> {
  static std::string Type() { return "three floats"; }
  static void Set(Eigen::Vector3d* value, py::handle given, const std::string& name) {
    const Eigen::VectorXd numbers = ToVector(given, name);
    if (numbers.size() != 3) throw py::value_error(name + ": must be three numbers");
    *value = numbers;
  }
  static py::object Get(const Eigen::Vector3d& value) {
    return py::make_tuple(value[0], value[1], value[2]);
  }
};

template <>
struct Value<Eigen::VectorXd> {
  static std::string Type() { return "array of float"; }
  static void Set(Eigen::VectorXd* value, py::handle given, const std::string& name) {
    *value = given.is_none() ? Eigen::VectorXd() : ToVector(given, name);
  }
  static py::object Get(const Eigen::VectorXd& value) {
    return value.size() == 0 ? py::object(py::none()) : FromMatrix(value);
  }
};

template <>
struct Value<std::vector<double>> {
  static std::string Type() { return "array of float"; }
  static void Set(std::vector<double>* value, py::handle given, const std::string& name) {
    value->clear();
    if (given.is_none()) return;
    const Eigen::VectorXd numbers = ToVector(given, name);
    value->assign(numbers.begin(), numbers.end());
  }
  static py::object Get(const std::vector<double>&) { return py::none(); }
};

/// Features by name, in the order of the dict.
template <>
struct Value<std::vector<FeatureTerm>> {
  static std::string Type() { return "dict of str to float"; }
  static void Set(std::vector<FeatureTerm>* value, py::handle given, const std::string& name);
  static py::object Get(const std::vector<FeatureTerm>& value);
};

template <>
struct Value<Eigen::Matrix3Xd> {
  static std::string Type() { return "array of float, vertices x 3"; }
  static void Set(Eigen::Matrix3Xd* value, py::handle given, const std::string& name) {
    *value = given.is_none() ? Eigen::Matrix3Xd() : Eigen::Matrix3Xd(ToShape(given, name));
  }
  static py::object Get(const Eigen::Matrix3Xd&) { return py::none(); }
};

template <>
struct Value<std::vector<Eigen::VectorXd>> {
  static std::string Type() { return "array of float, shapes x vertices"; }
  static void Set(std::vector<Eigen::VectorXd>* value, py::handle given, const std::string& name) {
    value->clear();
    if (given.is_none()) return;
    for (py::handle row : given) {
      value->push_back(ToVector(row, NumberedName(name, value->size())));
    }
  }
  static py::object Get(const std::vector<Eigen::VectorXd>&) { return py::none(); }
};

template <>
struct Value<std::vector<Shape>> {
  static std::string Type() { return "array of float, shapes x vertices x 3"; }
  static void Set(std::vector<Shape>* value, py::handle given, const std::string& name) {
    value->clear();
    if (given.is_none()) return;
    for (py::handle shape : given) {
      value->push_back(ToShape(shape, NumberedName(name, value->size())));
    }
  }
  static py::object Get(const std::vector<Shape>&) { return py::none(); }
};

template <>
struct Value<std::optional<Obstacle>> {
  static std::string Type() { return "Poses, or (vertices, faces)"; }
  static void Set(std::optional<Obstacle>* value, py::handle given, const std::string& name);
  static py::object Get(const std::optional<Obstacle>&) { return py::none(); }
};

template <>
struct Value<Eigen::VectorXi> {
  static std::string Type() { return "array of int"; }
  static void Set(Eigen::VectorXi* value, py::handle given, const std::string& name) {
    *value = given.is_none() ? Eigen::VectorXi() : ToIntegers(given, name);
  }
  static py::object Get(const Eigen::VectorXi&) { return py::none(); }
};

template <>
struct Value<MetricOptions> {
  static std::string Type() { return "MetricOptions, Metric or str"; }
  static void Set(MetricOptions* value, py::handle given, const std::string& name);
  static py::object Get(const MetricOptions& value) { return python::Get(value); }
};

/// A metric that may be left out. The function that takes the options sets it to the metric of its
/// mesh first, and a dict from Python then changes fields of that.
template <>
struct Value<std::optional<MetricOptions>> {
  static std::string Type() { return Value<MetricOptions>::Type(); }
  static void Set(std::optional<MetricOptions>* value, py::handle given, const std::string& name) {
    if (!value->has_value()) value->emplace();
    Value<MetricOptions>::Set(&**value, given, name);
  }
  static py::object Get(const std::optional<MetricOptions>&) { return py::none(); }
};

template <typename Options>
const Fields<Options>& FieldsOf() {
  static const Fields<Options> fields = [] {
    Fields<Options> rows;
    internal::ForOptions(
        internal::Of<Options>(), [&](const std::string& name, auto field, const char* about) {
          using T = std::decay_t<decltype(std::invoke(field, std::declval<Options&>()))>;
          const auto set = [name, field](Options* options, py::handle given) {
            Value<T>::Set(&std::invoke(field, *options), given, name);
          };
          const auto get = [field](const Options& options) {
            return Value<T>::Get(std::invoke(field, options));
          };
          rows.push_back({name == "lambda" ? "lambda_" : name, Value<T>::Type(), about, set, get});
        });
    return rows;
  }();
  return fields;
}

/// What Python is told of each row of the table `name` of options: name, type, default, meaning.
py::list DescribeOptions(const std::string& name);

}  // namespace shapespace::python

#endif  // SHAPESPACE_PYTHON_OPTIONS_H_
