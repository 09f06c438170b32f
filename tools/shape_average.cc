// Computes the mean of poses of a mesh.

#include <utility>

#include <gflags/gflags.h>

#include <shapespace/files/write.h>
#include <shapespace/statistics/average.h>

