#ifndef SHAPESPACE_TOOLS_SUPPORT_LISTS_H_
#define SHAPESPACE_TOOLS_SUPPORT_LISTS_H_

#include <string>
#include <vector>

namespace shapespace::tools {

/// The parts of `list` between commas, without the blanks around them.
std::vector<std::string> Split(const std::string& list);

/// The numbers that `text`, the value of `flag`, lists with commas between them.
/// \throw UsageError naming the flag and what is no number.
std::vector<double> NumbersFromFlag(const std::string& flag, const std::string& text);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_LISTS_H_
