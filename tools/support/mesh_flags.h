#ifndef SHAPESPACE_TOOLS_SUPPORT_MESH_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_MESH_FLAGS_H_

#include <gflags/gflags.h>

DECLARE_bool(allow_mirrored);
DECLARE_bool(allow_mismatch);
DECLARE_bool(allow_nonmanifold);
DECLARE_bool(open_seams);

namespace shapespace::tools {

/// The axis of --mirror, 'x', 'y' or 'z'; 0 if the flag was not given. \throw UsageError.
char MirrorFromFlags();

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_MESH_FLAGS_H_
