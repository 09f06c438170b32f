#ifndef SHAPESPACE_TOOLS_SUPPORT_MESH_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_MESH_FLAGS_H_

#include <gflags/gflags.h>

#include <shapespace/files/read.h>

DECLARE_bool(allow_mirrored);
DECLARE_bool(allow_mismatch);
DECLARE_bool(allow_nonmanifold);
DECLARE_bool(open_seams);

namespace shapespace::tools {

/// What --allow_mirrored, --allow_mismatch, --allow_nonmanifold and --open_seams say; the other
/// options have their defaults.
ReadOptions MeshOptionsFromFlags();

/// The axis of --mirror, 'x', 'y' or 'z'; 0 if the flag was not given. \throw UsageError.
char MirrorFromFlags();

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_MESH_FLAGS_H_
