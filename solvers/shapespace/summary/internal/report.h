#ifndef SHAPESPACE_SUMMARY_INTERNAL_REPORT_H_
#define SHAPESPACE_SUMMARY_INTERNAL_REPORT_H_

#include <cmath>
#include <cstdio>
#include <string>

#include <nlohmann/json.hpp>

#include <shapespace/base/internal/fields.h>
#include <shapespace/summary/termination.h>

// Helpers for the reports of all solvers.

namespace shapespace::internal {

/// printf into a string; the result is truncated after 511 characters.
template <typename... Arguments>
std::string Format(const char* format, Arguments... arguments) {
  char text[512];
  std::snprintf(text, sizeof text, format, arguments...);
  return text;
}

/// `text`, which has `value`; "n/a" if that was not computed.
inline std::string IfComputed(double value, const std::string& text) {
  return std::isnan(value) ? "n/a" : text;
}

/// JSON has no NaN: a value that is not finite becomes null.
inline nlohmann::ordered_json JsonNumber(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

/// How a solve ended, in words.
const char* Name(Termination termination);
inline Words<Termination> WordsOf(Of<Termination>) {
  return {{"converged", Termination::kConverged},
          {"max_iterations", Termination::kMaxIterations},
          {"stalled", Termination::kStalled},
          {"cancelled", Termination::kCancelled}};
}
/// The value for calls that consist of several solves.
inline const char* EndingKey(bool converged, bool cancelled) {
  return cancelled ? "cancelled" : converged ? "converged" : "not_converged";
}

/// A line of a report; empty if contact was not to be avoided (-1 segments).
inline std::string ContactText(int uncertified_segments, double contact_distance) {
  return uncertified_segments < 0 ? std::string()
                                  : Format(
                                        "Contact           %d segments not shown to be free of it; "
                                        "least distance %.4g\n",
                                        uncertified_segments, contact_distance);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SUMMARY_INTERNAL_REPORT_H_
