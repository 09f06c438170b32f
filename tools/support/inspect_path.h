#ifndef SHAPESPACE_TOOLS_SUPPORT_INSPECT_PATH_H_
#define SHAPESPACE_TOOLS_SUPPORT_INSPECT_PATH_H_

#include <string>

#include "support/telling.h"

namespace shapespace::tools {

/// Tells what is in a .path file, and returns the same for a report.
/// \throw FileError.
Json InspectPath(const std::string& file, Telling* told);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_INSPECT_PATH_H_
