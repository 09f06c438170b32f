#include <algorithm>
#include <cmath>
#include <sstream>

#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/internal/summary_fields.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
namespace {

using internal::Format;

const char* Name(GeodesicIntegrator integrator) {
  return integrator == GeodesicIntegrator::kVariational ? "variational" : "first integral (7)";
}

}  // namespace

bool ExponentialSummary::Converged() const {
  return (ending == Ending::kComplete || ending == Ending::kContact) &&
         std::all_of(steps.begin(), steps.end(),
                     [&](const Step& step) { return step.converged && step.vertices == vertices; });
}

std::string ExponentialSummary::BriefReport() const {
  const int open =
      static_cast<int>(std::count_if(steps.begin(), steps.end(), [&](const Step& step) {
        return !step.converged || step.vertices < vertices;
      }));
  const bool touches = ending == Ending::kContact;
  std::string text;
  if (Converged()) {
    text = touches ? "ended before contact" : "converged";
  } else if (ending == Ending::kComplete || touches) {
    text = Format("%d steps NOT CONVERGED on the mesh itself%s", open,
                  touches ? ", ended before contact" : "");
  } else {
    text = "STOPPED EARLY";
  }
  text += Format(": %d vertices, %zu of %d steps", vertices, steps.size(), requested_steps);
  if (!steps.empty()) {
    text += Format("; energy %.6g to %.6g, edges off by %.3g%% rms from the first shape",
                   steps.front().energy, steps.back().energy, 100 * steps.back().edge_rms);
  }
  return text + Format("; %.2f s", total_seconds);
}

std::string ExponentialSummary::FullReport() const {
  std::ostringstream out;
  out << "Ending            "
      << (ending == Ending::kComplete  ? Converged() ? "complete, converged" : "complete"
          : ending == Ending::kContact ? "before contact: " + stopped
                                       : "STOPPED EARLY: " + stopped)
      << "\nIntegrator        " << Name(integrator) << "\nMetric            " << metric
      << Format("\nMesh              %d vertices\n", vertices)
      << internal::ContactText(uncertified_segments, contact_distance) << '\n'
      << "       t  solved on  increments  iterations  Krylov   residual        energy  "
         "momentum drift  edges rms   edges max  inverted  seconds\n";
  for (const Step& step : steps) {
    out << Format(
        "%8.4g %10d %11d %11d %7d %10.1e %13.6g %15.1e %9.3g%% %10.3g%% %8.2g%% %8.3f%s\n", step.t,
        step.vertices, step.increments, step.iterations, step.krylov_iterations, step.residual,
        step.energy, step.momentum_drift, 100 * step.edge_rms, 100 * step.edge_max,
        100 * step.inverted, step.seconds, step.converged ? "" : "  (not converged)");
  }
  out << Format("\nTime              %.3f s, of which %d factorisations %.3f\n", total_seconds,
                factorisations, factor_seconds);
  for (const std::string& warning : warnings) out << "Warning: " << warning << '\n';
  return out.str();
}

std::string ExponentialSummary::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

}  // namespace shapespace
