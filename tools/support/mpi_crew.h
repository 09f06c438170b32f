#ifndef SHAPESPACE_TOOLS_SUPPORT_MPI_CREW_H_
#define SHAPESPACE_TOOLS_SUPPORT_MPI_CREW_H_

#include <functional>

#include <shapespace/exploration/process_pool.h>

namespace shapespace::tools {

/// Runs `body` with the crew of this process: the ranks started by mpirun, or this process alone.
/// Other ranks than the first print nothing unless they fail; then all ranks end with exit code 1.
/// A usage error, which occurs on all ranks, is thrown on the first only.
/// \throw UsageError if mpirun has started several processes of a program without MPI.
void WithCrew(const std::function<void(ProcessPool*)>& body);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_MPI_CREW_H_
