#include "support/mesh_flags.h"

#include <string>

#include "support/flag_group.h"
#include "support/tool.h"

DEFINE_bool(allow_nonmanifold, false,
            "accept meshes with non-manifold edges or vertices, or inconsistent winding");
DEFINE_bool(open_seams, false,
            "leave the surface open where borders lie on each other in all poses, as lips do that "
            "never part; by default their vertices are joined, because most files store vertices "
            "several times where texture coordinates, normals or materials change");
DEFINE_string(
    mirror, "",
    "x, y or z: change the sign of this coordinate in poses that are mirror images of the first, "
    "which are refused without this flag");
DEFINE_bool(allow_mirrored, false,
            "take poses that look like mirror images of the first as they are: domes that are "
            "pushed through, bodies that are turned inside out");
DEFINE_bool(
    allow_mismatch, false,
    "take poses as they are whose units, or order of vertices, seem to be others than those "
    "of the first");
FLAG_GROUP(mesh, "Input", "");

namespace shapespace::tools {

ReadOptions MeshOptionsFromFlags() {
  ReadOptions options;
  options.allow_mirrored = FLAGS_allow_mirrored;
  options.allow_mismatch = FLAGS_allow_mismatch;
  options.allow_nonmanifold = FLAGS_allow_nonmanifold;
  options.open_seams = FLAGS_open_seams;
  return options;
}

char MirrorFromFlags() {
  if (FLAGS_mirror.empty()) return 0;
  if (FLAGS_mirror != "x" && FLAGS_mirror != "y" && FLAGS_mirror != "z") {
    throw UsageError("--mirror " + FLAGS_mirror + ": must be x, y or z");
  }
  return FLAGS_mirror[0];
}

}  // namespace shapespace::tools
