#include "support/lists.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

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

}  // namespace shapespace::tools
