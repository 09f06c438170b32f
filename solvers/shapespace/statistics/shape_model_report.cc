#include <sstream>

#include <shapespace/statistics/internal/summary_fields.h>
#include <shapespace/statistics/shape_model.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {

std::string ShapeModelSummary::BriefReport() const {
  std::string first;
  for (int k = 0; k < std::min(modes, 3); ++k) {
    first += internal::Format(k > 0 ? ", %.1f" : "; %.1f", 100 * variances[k]);
  }
  return internal::Format("%s: %d vertices, %d poses, %d modes",
                          internal::Name(average.termination), average.vertices, average.poses,
                          modes) +
         first +
         internal::Format("%s; %.2f s", first.empty() ? "" : "% of the variance", total_seconds);
}

std::string ShapeModelSummary::FullReport() const {
  std::ostringstream out;
  out << average.FullReport() << internal::Format("Modes             %d of %d\n", modes, rank);
  double sum = 0;
  for (size_t k = 0; k < variances.size(); ++k) {
    sum += variances[k];
    out << internal::Format(
        "  mode %-3d        %6.2f%% of the variance, %6.2f%% with those before\n",
        static_cast<int>(k) + 1, 100 * variances[k], 100 * sum);
  }
  out << internal::Format("Seconds           %.3f with the modes\n", total_seconds);
  for (size_t i = average.warnings.size(); i < warnings.size(); ++i) {
    out << "Warning: " << warnings[i] << '\n';
  }
  return out.str();
}

std::string ShapeModelSummary::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

}  // namespace shapespace
