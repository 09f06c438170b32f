#ifndef SHAPESPACE_SUMMARY_INTERNAL_MEMORY_H_
#define SHAPESPACE_SUMMARY_INTERNAL_MEMORY_H_

#include <string>

namespace shapespace::internal {

// Refusals of what needs more memory than permitted. Estimates are in the rooms whose memory they
// estimate (memory.h): bytes of what a call needs at its peak, in addition to its input. The size
// of factors depends on the mesh and is estimated for unfavourable ones: on bodies of 2 K to 43 K
// vertices the peaks were 60 to 90 % of the estimates, for geodesics with few shapes nearly 100 %.

/// \throw InvalidOptions if the limit is not positive.
void CheckMemoryLimit(double memory_limit);

/// \throw SolverError if `bytes`, the estimate for `call` ("this solve"), exceed the limit;
///        `remedy` ("insert fewer shapes") says what needs less.
void CheckMemory(const std::string& call, double bytes, double memory_limit,
                 const std::string& remedy);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SUMMARY_INTERNAL_MEMORY_H_
