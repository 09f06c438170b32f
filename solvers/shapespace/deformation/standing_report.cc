#include <shapespace/deformation/internal/summary_fields.h>
#include <shapespace/deformation/standing.h>
#include <shapespace/numerics/internal/json_of.h>
#include <shapespace/numerics/internal/report.h>

namespace shapespace {

std::string StandingSummary::BriefReport() const {
  return internal::Format(
      "%s: %d standing parts held in %d shapes; they slide by %.2g%% of the diagonal (before: "
      "%.2g%%), and are %.2g%% apart in the poses; edges off by at most %.2g%% rms; %.2f s",
      internal::Name(termination), parts, shapes, 100 * slide, 100 * slide_before, 100 * drift,
      100 * edge_rms, seconds);
}

std::string StandingSummary::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

}  // namespace shapespace
