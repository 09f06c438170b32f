#include <shapespace/deformation/internal/summary_fields.h>
#include <shapespace/deformation/standing.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {

std::string StandingSummary::BriefReport() const {
  const auto percent = [](double share) {
    return internal::IfComputed(share, internal::Format("%.2g%%", 100 * share));
  };
  return internal::Format("%s: %d standing parts held in %d shapes; they slide by ",
                          internal::Name(termination), parts, shapes) +
         percent(slide) + " of the diagonal (before: " + percent(slide_before) + "), and are " +
         percent(drift) + " apart in the poses; edges off by at most " + percent(edge_rms) +
         internal::Format(" rms; %.2f s", seconds);
}

std::string StandingSummary::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

}  // namespace shapespace
