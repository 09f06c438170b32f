#ifndef SHAPESPACE_TOOLS_SUPPORT_MPI_CREW_H_
#define SHAPESPACE_TOOLS_SUPPORT_MPI_CREW_H_

#include <functional>

#include <shapespace/solvers/exploration/crew.h>

namespace shapespace::tools {

/// Runs `body` with the crew that this process belongs to: the ranks that mpirun has started, or
/// this process alone. Ranks but the first are silent, unless something fails there; then all end,
/// with exit code 1. A usage error, which all ranks make, is thrown on the first alone.
/// \throw UsageError if mpirun has started several of a program that was built without MPI.
void WithCrew(const std::function<void(Crew*)>& body);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_MPI_CREW_H_
