#ifndef SHAPESPACE_TRANSFER_INTERNAL_OPTION_FIELDS_H_
#define SHAPESPACE_TRANSFER_INTERNAL_OPTION_FIELDS_H_

#include <shapespace/exponential/internal/option_fields.h>
#include <shapespace/transfer/transfer.h>

// The fields of options, and the words of enumerations (base/internal/fields.h).

namespace shapespace::internal {

inline Words<TransferMethod> WordsOf(Of<TransferMethod>) {
  return {{"features", TransferMethod::kFeatures}, {"ladder", TransferMethod::kLadder}};
}

template <typename Visit>
void ForOptions(Of<LadderOptions>, const Visit& visit) {
  visit("metric", &LadderOptions::metric, "Under which the two bodies are compared.");
  visit("rung_shapes", &LadderOptions::rung_shapes,
        "Shapes between one of the source and the target's that corresponds to it; odd, because "
        "the middle one is the hybrid.");
  visit("scale", &LadderOptions::scale,
        "Scale the source to the target's size before they are compared.");
  visit("align", &LadderOptions::align,
        "Turn the source onto the target before they are compared.");
  visit("connection", &LadderOptions::connection,
        "What carries the source's velocity along a rung: the metric's own connection, or the "
        "paper's projection.");
  visit("tolerance", &LadderOptions::tolerance, "Of the geodesics that are the rungs.");
}

template <typename Visit>
void ForOptions(Of<TransferOptions>, const Visit& visit) {
  visit("method", &TransferOptions::method,
        "Strains and angles change as the source's do, or the paper's ladder: geodesics between "
        "the bodies, parallel transport and the exponential map.");
  visit("metric", &TransferOptions::metric,
        "Of the method 'features': costs of strains, of angles and, as lambda, of positions.");
  visit("tolerance", &TransferOptions::tolerance,
        "Of the method 'features': a shape is found when an iteration gains less than this.");
  visit("max_iterations", &TransferOptions::max_iterations, "Of the method 'features', a shape.");
  visit("hybrids", &TransferOptions::hybrids,
        "Make the bodies half way between source and target too.");
  visit("avoid_contact", &TransferOptions::avoid_contact,
        "Whether the target must not pass through itself: parts slide along each other.");
  visit("ladder", &TransferOptions::ladder, "Of the ladder, and of hybrids.");
  visit("memory_limit", &TransferOptions::memory_limit,
        "Bytes that the transfer may take; an estimate above it is refused at once.");
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_TRANSFER_INTERNAL_OPTION_FIELDS_H_
