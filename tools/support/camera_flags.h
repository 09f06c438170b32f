#ifndef SHAPESPACE_TOOLS_SUPPORT_CAMERA_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_CAMERA_FLAGS_H_

#include <shapespace/output/page.h>

namespace shapespace::tools {

/// The values of --up and --view; zero where they are not given.
/// \throw UsageError if one is no direction, or both are parallel.
PageView ViewFromFlags();

/// 'y' or 'z', as files of animations have it; 'y' without --up.
/// \throw UsageError naming `file` if --up is another direction.
char UpOfAnimation(const std::string& file);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_CAMERA_FLAGS_H_
