#include "support/numbers.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "support/tool.h"

namespace shapespace::tools {

std::vector<double> NumbersFromFlag(const std::string& flag, const std::string& text) {
  std::vector<double> numbers;
  std::stringstream list(text);
  for (std::string item; std::getline(list, item, ',');) {
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
