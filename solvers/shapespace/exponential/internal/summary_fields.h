#ifndef SHAPESPACE_EXPONENTIAL_INTERNAL_SUMMARY_FIELDS_H_
#define SHAPESPACE_EXPONENTIAL_INTERNAL_SUMMARY_FIELDS_H_

#include <shapespace/analysis/internal/summary_fields.h>
#include <shapespace/base/internal/fields.h>
#include <shapespace/exponential/correction.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/internal/option_fields.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/summary/internal/report.h>

// The fields of summaries (base/internal/fields.h).

namespace shapespace::internal {

inline Words<ExponentialSummary::Ending> WordsOf(Of<ExponentialSummary::Ending>) {
  return {{"complete", ExponentialSummary::Ending::kComplete},
          {"degenerate", ExponentialSummary::Ending::kDegenerate},
          {"contact", ExponentialSummary::Ending::kContact},
          {"cancelled", ExponentialSummary::Ending::kCancelled}};
}

template <typename Visit>
void ForFields(Of<ExponentialSummary::Step>, const Visit& visit) {
  visit("t", &ExponentialSummary::Step::t);
  visit("converged", &ExponentialSummary::Step::converged);
  visit("vertices", &ExponentialSummary::Step::vertices);
  visit("increments", &ExponentialSummary::Step::increments);
  visit("iterations", &ExponentialSummary::Step::iterations);
  visit("krylov_iterations", &ExponentialSummary::Step::krylov_iterations);
  visit("residual", &ExponentialSummary::Step::residual);
  visit("energy", &ExponentialSummary::Step::energy);
  visit("momentum_drift", &ExponentialSummary::Step::momentum_drift);
  visit("edge_rms", &ExponentialSummary::Step::edge_rms);
  visit("edge_max", &ExponentialSummary::Step::edge_max);
  visit("inverted", &ExponentialSummary::Step::inverted);
  visit("seconds", &ExponentialSummary::Step::seconds);
}

template <typename Visit>
void ForFields(Of<ExponentialSummary>, const Visit& visit) {
  visit("termination", [](const ExponentialSummary& s) {
    return s.ending == ExponentialSummary::Ending::kDegenerate ? "degenerate"
           : s.ending == ExponentialSummary::Ending::kContact && s.Converged()
               ? "contact"
               : EndingKey(s.Converged(), s.ending == ExponentialSummary::Ending::kCancelled);
  });
  visit("converged", &ExponentialSummary::Converged);
  visit("ending", &ExponentialSummary::ending);
  visit("stopped", &ExponentialSummary::stopped);
  visit("integrator", &ExponentialSummary::integrator);
  visit("vertices", &ExponentialSummary::vertices);
  visit("requested_steps", &ExponentialSummary::requested_steps);
  visit("metric", &ExponentialSummary::metric);
  visit("steps", &ExponentialSummary::steps);
  visit("uncertified_segments", &ExponentialSummary::uncertified_segments);
  visit("contact_distance", &ExponentialSummary::contact_distance);
  visit("total_seconds", &ExponentialSummary::total_seconds);
  visit("factor_seconds", &ExponentialSummary::factor_seconds);
  visit("factorisations", &ExponentialSummary::factorisations);
  visit("warnings", &ExponentialSummary::warnings);
}

template <typename Visit>
void ForFields(Of<CorrectionSummary>, const Visit& visit) {
  visit("termination", &CorrectionSummary::termination);
  visit("converged", &CorrectionSummary::converged);
  visit("mode", &CorrectionSummary::mode);
  visit("mu", &CorrectionSummary::mu);
  visit("vertices", &CorrectionSummary::vertices);
  visit("shapes", &CorrectionSummary::shapes);
  visit("iterations", &CorrectionSummary::iterations);
  visit("evaluations", &CorrectionSummary::evaluations);
  visit("initial_energy", &CorrectionSummary::initial_energy);
  visit("energy", &CorrectionSummary::energy);
  visit("initial_quality", &CorrectionSummary::initial_quality);
  visit("quality", &CorrectionSummary::quality);
  visit("distance", &CorrectionSummary::distance);
  visit("deformation_left", &CorrectionSummary::deformation_left);
  visit("total_seconds", &CorrectionSummary::total_seconds);
  visit("warnings", &CorrectionSummary::warnings);
}

template <typename Visit>
void ForFields(Of<TransportSummary::Step>, const Visit& visit) {
  visit("krylov_iterations", &TransportSummary::Step::krylov_iterations);
  visit("residual", &TransportSummary::Step::residual);
  visit("seconds", &TransportSummary::Step::seconds);
}

template <typename Visit>
void ForFields(Of<TransportSummary>, const Visit& visit) {
  visit("converged", &TransportSummary::converged);
  visit("metric", &TransportSummary::metric);
  visit("steps", &TransportSummary::steps);
  visit("first_norm", &TransportSummary::first_norm);
  visit("last_norm", &TransportSummary::last_norm);
  visit("estimated_bytes", &TransportSummary::estimated_bytes);
  visit("total_seconds", &TransportSummary::total_seconds);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPONENTIAL_INTERNAL_SUMMARY_FIELDS_H_
