#include <shapespace/summary/internal/report.h>

namespace shapespace::internal {

const char* Name(Termination termination) {
  switch (termination) {
    case Termination::kConverged:
      return "converged";
    case Termination::kMaxIterations:
      return "NOT CONVERGED: out of iterations";
    case Termination::kStalled:
      return "NOT CONVERGED: stalled";
    case Termination::kCancelled:
      break;
  }
  return "NOT CONVERGED: cancelled";
}

}  // namespace shapespace::internal
