#include <shapespace/summary/internal/memory.h>

#include <cmath>

#include <shapespace/base/error.h>

namespace shapespace::internal {

void CheckMemoryLimit(double memory_limit) {
  if (!(memory_limit > 0)) throw InvalidOptions("memory_limit", "must be positive");
}

void CheckMemory(const std::string& call, double bytes, double memory_limit,
                 const std::string& remedy) {
  if (bytes <= memory_limit) return;
  throw SolverError(call + " needs about " + std::to_string(std::lround(bytes / 1e6)) +
                    " MB, more than the memory limit; " + remedy + " or raise memory_limit");
}

}  // namespace shapespace::internal
