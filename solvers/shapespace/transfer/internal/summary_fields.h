#ifndef SHAPESPACE_TRANSFER_INTERNAL_SUMMARY_FIELDS_H_
#define SHAPESPACE_TRANSFER_INTERNAL_SUMMARY_FIELDS_H_

#include <shapespace/base/internal/fields.h>
#include <shapespace/geodesic/internal/summary_fields.h>
#include <shapespace/summary/internal/report.h>
#include <shapespace/transfer/internal/option_fields.h>
#include <shapespace/transfer/transfer.h>

// The fields of summaries (base/internal/fields.h).

namespace shapespace::internal {

template <typename Visit>
void ForFields(Of<TransferSummary::Step>, const Visit& visit) {
  visit("converged", &TransferSummary::Step::converged);
  visit("iterations", &TransferSummary::Step::iterations);
  visit("on_mesh", &TransferSummary::Step::on_mesh);
  visit("ratio", &TransferSummary::Step::ratio);
  visit("norm_change", &TransferSummary::Step::norm_change);
  visit("warnings", &TransferSummary::Step::warnings);
  visit("seconds", &TransferSummary::Step::seconds);
}

template <typename Visit>
void ForFields(Of<TransferSummary>, const Visit& visit) {
  visit("termination",
        [](const TransferSummary& s) { return EndingKey(s.Converged(), s.cancelled); });
  visit("converged", &TransferSummary::Converged);
  visit("method", &TransferSummary::method);
  visit("vertices", &TransferSummary::vertices);
  visit("metric", &TransferSummary::metric);
  visit("scale", &TransferSummary::scale);
  visit("steps", &TransferSummary::steps);
  visit("strain_rms", &TransferSummary::strain_rms);
  visit("strain_max", &TransferSummary::strain_max);
  visit("angle_rms", &TransferSummary::angle_rms);
  visit("uncertified_segments", &TransferSummary::uncertified_segments);
  visit("contact_distance", &TransferSummary::contact_distance);
  visit("cancelled", &TransferSummary::cancelled);
  visit("estimated_bytes", &TransferSummary::estimated_bytes);
  visit("total_seconds", &TransferSummary::total_seconds);
  visit("warnings", &TransferSummary::warnings);
}

template <typename Visit>
void ForFields(Of<PoseTransferSummary>, const Visit& visit) {
  visit("termination",
        [](const PoseTransferSummary& s) { return EndingKey(s.Converged(), s.cancelled); });
  visit("converged", &PoseTransferSummary::Converged);
  visit("geodesics", &PoseTransferSummary::geodesics);
  visit("transfers", &PoseTransferSummary::transfers);
  visit("cancelled", &PoseTransferSummary::cancelled);
  visit("warnings", &PoseTransferSummary::Warnings);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_TRANSFER_INTERNAL_SUMMARY_FIELDS_H_
