#include <algorithm>
#include <cmath>
#include <sstream>

#include <shapespace/summary/internal/json_of.h>
#include <shapespace/transfer/internal/summary_fields.h>

#include <shapespace/summary/internal/report.h>
#include <shapespace/transfer/transfer.h>

namespace shapespace {
namespace {

using internal::Format;

std::string DegreesText(double angle) {
  return internal::IfComputed(angle, Format("%.3g degrees", angle));
}

const char* Ending(bool converged) { return converged ? "converged" : "NOT CONVERGED"; }

}  // namespace

bool TransferSummary::Converged() const {
  return !cancelled && !steps.empty() &&
         std::all_of(steps.begin(), steps.end(),
                     [](const Step& step) { return step.converged && step.on_mesh; });
}

std::string TransferSummary::BriefReport() const {
  return Format(
      "%s: %d vertices, %zu shapes; target %.4g times as large; strains off by %.3g%% rms, "
      "dihedral angles by %s; %.2f s",
      Ending(Converged()), vertices, steps.size(), scale, 100 * strain_rms,
      DegreesText(angle_rms).c_str(), total_seconds);
}

std::string TransferSummary::FullReport() const {
  std::ostringstream out;
  out << "Ending            " << Ending(Converged()) << "\nMetric            " << metric
      << Format("\nMesh              %d vertices; target %.6g times as large as the source\n",
                vertices, scale)
      << Format("Strains, last     off by %.4g%% rms, %.4g%% at most\n", 100 * strain_rms,
                100 * strain_max)
      << "Angles, last      "
      << internal::IfComputed(angle_rms, Format("off by %.4g degrees rms", angle_rms)) << '\n'
      << internal::ContactText(uncertified_segments, contact_distance)
      << "\nshape  iterations  seconds"
      << (method == TransferMethod::kLadder ? "  energy / bound  norm changes\n" : "\n");
  for (size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    out << Format("%5zu  %10d  %7.3f", i + 2, step.iterations, step.seconds);
    if (method == TransferMethod::kLadder) {
      out << Format("  %14.5f  %12.3g", step.ratio, step.norm_change);
    }
    out << (step.on_mesh ? "" : "  (on a coarser mesh)")
        << (step.converged ? "" : "  (not converged)") << '\n';
  }
  out << Format("\nTime              %.3f s\n", total_seconds);
  for (const std::string& warning : warnings) out << "Warning: " << warning << '\n';
  return out.str();
}

std::string TransferSummary::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

bool PoseTransferSummary::Converged() const {
  return !cancelled && !transfers.empty() &&
         std::all_of(
             geodesics.begin(), geodesics.end(),
             [](const auto& path) { return path.termination == Termination::kConverged; }) &&
         std::all_of(transfers.begin(), transfers.end(),
                     [](const auto& transfer) { return transfer.Converged(); });
}

std::vector<std::string> PoseTransferSummary::Warnings() const {
  if (geodesics.empty())
    return transfers.empty() ? std::vector<std::string>() : transfers[0].warnings;
  std::vector<std::string> warnings;
  if (cancelled) warnings.push_back("cancelled: only the poses before this point were computed");
  for (size_t i = 0; i < transfers.size(); ++i) {
    for (const auto* some : {&geodesics[i].warnings, &transfers[i].warnings}) {
      for (const std::string& warning : *some) {
        warnings.push_back("pose " + std::to_string(i + 2) + ": " + warning);
      }
    }
  }
  return warnings;
}

std::string PoseTransferSummary::BriefReport() const {
  if (transfers.empty()) return "no pose was transferred";
  if (geodesics.empty()) return transfers[0].BriefReport();
  double strain = kNotComputed, angle = kNotComputed, seconds = 0;
  size_t steps = 0;
  for (size_t i = 0; i < transfers.size(); ++i) {
    strain = std::fmax(strain, transfers[i].strain_rms);
    angle = std::fmax(angle, transfers[i].angle_rms);
    steps += transfers[i].steps.size();
    seconds += geodesics[i].total_seconds + transfers[i].total_seconds;
  }
  return Format(
      "%s: %d vertices, %zu poses in %zu steps; target %.4g times as large; strains off by up to "
      "%.3g%% rms, dihedral angles by %s; %.2f s",
      Ending(Converged()), transfers[0].vertices, transfers.size(), steps, transfers[0].scale,
      100 * strain, DegreesText(angle).c_str(), seconds);
}

std::string PoseTransferSummary::FullReport() const {
  if (geodesics.empty()) return transfers.empty() ? "" : transfers[0].FullReport();
  std::ostringstream out;
  for (size_t i = 0; i < transfers.size(); ++i) {
    out << (i > 0 ? "\n" : "") << "Pose " << i + 2 << ", the geodesic to it\n"
        << geodesics[i].FullReport() << "\nPose " << i + 2 << ", its transfer\n"
        << transfers[i].FullReport();
  }
  return out.str();
}

std::string PoseTransferSummary::ToJson() const {
  if (geodesics.empty() && !transfers.empty()) return transfers[0].ToJson();
  return internal::TextOf(internal::JsonOf(*this));
}

}  // namespace shapespace
