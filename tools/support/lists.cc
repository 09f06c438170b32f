#include "support/lists.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "support/command_line.h"
#include "support/tool.h"

namespace shapespace::tools {

std::vector<std::string> Split(const std::string& list) {
  std::vector<std::string> parts;
  std::stringstream text(list);
  for (std::string part; std::getline(text, part, ',');) {
    const size_t begin = std::min(part.find_first_not_of(" \t\n"), part.size());
    parts.push_back(part.substr(begin, part.find_last_not_of(" \t\n") + 1 - begin));
  }
  return parts;
}

std::vector<double> NumbersFromFlag(const std::string& flag, const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& item : Split(text)) {
    char* end = nullptr;
    const double number = std::strtod(item.c_str(), &end);
    if (item.empty() || *end != '\0' || !std::isfinite(number)) {
      throw UsageError("--" + flag + " " + text + ": '" + item + "' is not a number");
    }
    numbers.push_back(number);
  }
  return numbers;
}

double ShareFromFlag(const std::string& flag, const std::string& text) {
  const bool is_percent = !text.empty() && text.back() == '%';
  const std::vector<double> numbers =
      NumbersFromFlag(flag, is_percent ? text.substr(0, text.size() - 1) : text);
  if (numbers.size() != 1) throw UsageError(AsTyped(flag) + ": must be one number");
  return is_percent ? numbers[0] / 100 : numbers[0];
}

}  // namespace shapespace::tools
