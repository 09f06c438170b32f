#ifndef SHAPESPACE_STATISTICS_INTERNAL_SUMMARY_FIELDS_H_
#define SHAPESPACE_STATISTICS_INTERNAL_SUMMARY_FIELDS_H_

#include <shapespace/base/internal/fields.h>
#include <shapespace/numerics/internal/report.h>
#include <shapespace/statistics/average.h>

// The fields of summaries (base/internal/fields.h).

namespace shapespace::internal {

template <typename Visit>
void ForFields(Of<AverageSummary>, const Visit& visit) {
  visit("termination", &AverageSummary::termination);
  visit("converged", &AverageSummary::Converged);
  visit("vertices", &AverageSummary::vertices);
  visit("triangles", &AverageSummary::triangles);
  visit("poses", &AverageSummary::poses);
  visit("metric", &AverageSummary::metric);
  visit("unit", &AverageSummary::unit);
  visit("variance", &AverageSummary::variance);
  visit("residual", &AverageSummary::residual);
  visit("energy", &AverageSummary::energy);
  visit("lower_bound", &AverageSummary::lower_bound);
  visit("ratio", &AverageSummary::Ratio);
  visit("edge_rms", &AverageSummary::edge_rms);
  visit("ambiguous_hinges", &AverageSummary::ambiguous_hinges);
  visit("iterations", &AverageSummary::iterations);
  visit("estimated_bytes", &AverageSummary::estimated_bytes);
  visit("certificate_seconds", &AverageSummary::certificate_seconds);
  visit("total_seconds", &AverageSummary::total_seconds);
  visit("warnings", &AverageSummary::warnings);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_STATISTICS_INTERNAL_SUMMARY_FIELDS_H_
