#include "support/memory_flag.h"

DEFINE_double(memory_limit, 8, "gigabytes that the run may take; more is refused beforehand");
