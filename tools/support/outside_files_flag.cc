#include "support/outside_files_flag.h"

#include "support/flag_group.h"

DEFINE_bool(
    allow_outside_files, false,
    "read files that an input names (buffers of .gltf, material libraries and textures) from "
    "outside of its own folder too; only for inputs that you trust");
FLAG_GROUP(outside_files, "Input", "");
