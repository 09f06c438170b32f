#include "support/nonmanifold_flag.h"

DEFINE_bool(allow_nonmanifold, false,
            "take meshes with non-manifold edges or vertices, or inconsistent winding");
