#ifndef SHAPESPACE_TOOLS_SUPPORT_LISTS_H_
#define SHAPESPACE_TOOLS_SUPPORT_LISTS_H_

#include <string>
#include <vector>

namespace shapespace::tools {

/// The parts of `list` between commas, without the blanks around them.
std::vector<std::string> Split(const std::string& list);

/// The numbers in `text`, the value of `flag`, separated by commas.
/// \throw UsageError naming the flag and the invalid number.
std::vector<double> NumbersFromFlag(const std::string& flag, const std::string& text);

/// The one number in `text`, the value of `flag`, which may be a percentage: .05 or 5%.
/// \throw UsageError naming the flag if it is none.
double ShareFromFlag(const std::string& flag, const std::string& text);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_LISTS_H_
