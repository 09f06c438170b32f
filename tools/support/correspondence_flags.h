#ifndef SHAPESPACE_TOOLS_SUPPORT_CORRESPONDENCE_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_CORRESPONDENCE_FLAGS_H_

#include <string>

#include <gflags/gflags.h>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/files/read.h>

DECLARE_string(markers);

namespace shapespace::tools {

/// The options of a correspondence according to the flags.
/// \throw UsageError.
CorrespondenceOptions CorrespondenceFromFlags();

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_CORRESPONDENCE_FLAGS_H_
