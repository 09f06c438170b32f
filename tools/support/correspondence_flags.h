#ifndef SHAPESPACE_TOOLS_SUPPORT_CORRESPONDENCE_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_CORRESPONDENCE_FLAGS_H_

#include <string>
#include <vector>

#include <gflags/gflags.h>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/files/read.h>

#include "support/files.h"

DECLARE_string(markers);

namespace shapespace::tools {

/// The files that --markers names: one with pairs of vertices, or two with landmarks of the
/// template and of the target. \throw UsageError if there are more.
std::vector<std::string> MarkerFilesFromFlag();

/// The markers in these files, with warnings. \throw FileError.
std::vector<CorrespondenceMarker> ReadMarkersAndTell(const Poses& template_mesh,
                                                     const Poses& target);

/// The file of --markers_out, if there is one. \throw FileError if it cannot be written.
FlagOutputs MarkersOutFromFlag();

/// Writes the markers that were used there, and says so. \throw FileError.
void WriteMarkersAndTell(const CorrespondenceResult& result);

/// The options of a correspondence according to the flags.
/// \throw UsageError.
CorrespondenceOptions CorrespondenceFromFlags();

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_CORRESPONDENCE_FLAGS_H_
