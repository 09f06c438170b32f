#include "support/memory_flag.h"

#include "support/flag_group.h"

DEFINE_double(memory_limit, 8,
              "memory limit in gigabytes; a run whose estimate exceeds it is refused");
FLAG_GROUP(memory, "Run", "");
