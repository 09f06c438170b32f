#include "options.h"

#include <cctype>

namespace shapespace::javascript {

std::string CamelCase(const std::string& name) {
  std::string result;
  bool upper = false;
  for (const char c : name) {
    if (c != '_') result += upper ? static_cast<char>(std::toupper(c)) : c;
    upper = c == '_';
  }
  return result;
}

void Refuse(const std::string& name, const std::string& type) {
  throw InvalidOptions(name, "must be " + type);
}

void RefuseUnknown(const std::string& name, const std::vector<std::string>& known) {
  std::string all;
  for (const std::string& one : known) all += (all.empty() ? "" : ", ") + one;
  throw InvalidOptions(name, "is no option here; there are " + all);
}

void Value<std::vector<double>>::Set(const val& given, const std::string& name,
                                     std::vector<double>* value) {
  *value = ToNumbers(given, name);
}

void Value<Eigen::VectorXd>::Set(const val& given, const std::string& name,
                                 Eigen::VectorXd* value) {
  std::vector<double> numbers;
  Value<std::vector<double>>::Set(given, name, &numbers);
  *value = Eigen::Map<const Eigen::VectorXd>(numbers.data(), numbers.size());
}

void Value<MetricOptions>::Set(const val& given, const std::string& name, MetricOptions* value) {
  const auto preset = [&](const val& word, const std::string& of) {
    const auto known = word.isString() ? internal::MetricPreset(word.as<std::string>())
                                       : std::optional<MetricOptions>();
    if (!known) Refuse(of, "'strain', 'isometric', 'rigid' or 'paper'");
    *value = *known;
  };
  if (given.isString()) return preset(given, name);
  val options = val::global("Object").call<val>("assign", val::object(), given);
  if (!options["preset"].isUndefined()) preset(options["preset"], name + ".preset");
  options.delete_(val("preset"));
  javascript::Set(options, value);
}

}  // namespace shapespace::javascript
