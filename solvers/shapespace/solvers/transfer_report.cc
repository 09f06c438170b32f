#include <algorithm>
#include <sstream>

#include <nlohmann/json.hpp>

#include <shapespace/solvers/report.h>
#include <shapespace/solvers/transfer.h>

namespace shapespace {
namespace {

using internal::Format;
using internal::JsonNumber;

nlohmann::ordered_json Json(const TransferSummary& summary) {
  nlohmann::ordered_json json;
  json["converged"] = summary.Converged();
  json["vertices"] = summary.vertices;
  json["metric"] = summary.metric;
  json["scale"] = summary.scale;
  json["rungs"] = nlohmann::ordered_json::array();
  for (const TransferSummary::Rung& rung : summary.rungs) {
    json["rungs"].push_back({{"converged", rung.converged},
                             {"on_mesh", rung.on_mesh},
                             {"energy_over_bound", JsonNumber(rung.ratio)},
                             {"norm_change", JsonNumber(rung.norm_change)},
                             {"seconds", rung.seconds}});
  }
  json["strain_off"] = {{"rms", summary.strain_rms}, {"max", summary.strain_max}};
  json["angle_off_degrees"] = summary.angle_rms;
  json["seconds"] = summary.total_seconds;
  json["warnings"] = summary.warnings;
  return json;
}

const char* Ending(bool converged) { return converged ? "converged" : "NOT CONVERGED"; }

}  // namespace

bool TransferSummary::Converged() const {
  return !cancelled && std::all_of(rungs.begin(), rungs.end(),
                                   [](const Rung& rung) { return rung.converged && rung.on_mesh; });
}

std::string TransferSummary::BriefReport() const {
  return Format(
      "%s: %d vertices, %zu rungs; target %.4g times as large; strains off by %.3g%% rms, dihedral "
      "angles by %.3g degrees; %.2f s",
      Ending(Converged()), vertices, rungs.size(), scale, 100 * strain_rms, angle_rms,
      total_seconds);
}

std::string TransferSummary::FullReport() const {
  std::ostringstream out;
  out << "Ending            " << Ending(Converged()) << "\nMetric            " << metric
      << Format("\nMesh              %d vertices; target %.6g times as large as the source\n",
                vertices, scale)
      << Format("Strains, last     off by %.4g%% rms, %.4g%% at most\n", 100 * strain_rms,
                100 * strain_max)
      << Format("Angles, last      off by %.4g degrees rms\n", angle_rms)
      << "\nrung  energy / bound  norm changes  seconds\n";
  for (size_t i = 0; i < rungs.size(); ++i) {
    const Rung& rung = rungs[i];
    out << Format("%4zu  %14.5f  %12.3g  %7.3f%s%s\n", i, rung.ratio, rung.norm_change,
                  rung.seconds, rung.on_mesh ? "" : "  (step on a coarser mesh)",
                  rung.converged ? "" : "  (not converged)");
  }
  out << Format("\nTime              %.3f s\n", total_seconds);
  for (const std::string& warning : warnings) out << "Warning: " << warning << '\n';
  return out.str();
}

std::string TransferSummary::ToJson() const { return Json(*this).dump(2) + "\n"; }

bool PoseTransferSummary::Converged() const {
  return !cancelled && std::all_of(geodesics.begin(), geodesics.end(), [](const auto& path) {
    return path.termination == Termination::kConverged;
  }) && std::all_of(transfers.begin(), transfers.end(), [](const auto& transfer) {
    return transfer.Converged();
  });
}

std::vector<std::string> PoseTransferSummary::Warnings() const {
  std::vector<std::string> warnings;
  if (cancelled) warnings.push_back("cancelled: the poses before are there, the others are not");
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
  double strain = 0, angle = 0, seconds = 0;
  size_t rungs = 0;
  for (size_t i = 0; i < transfers.size(); ++i) {
    strain = std::max(strain, transfers[i].strain_rms);
    angle = std::max(angle, transfers[i].angle_rms);
    rungs += transfers[i].rungs.size();
    seconds += geodesics[i].total_seconds + transfers[i].total_seconds;
  }
  return Format(
      "%s: %d vertices, %zu poses, %zu rungs; target %.4g times as large; strains off by up to "
      "%.3g%% rms, dihedral angles by %.3g degrees; %.2f s",
      Ending(Converged()), transfers[0].vertices, transfers.size(), rungs, transfers[0].scale,
      100 * strain, angle, seconds);
}

std::string PoseTransferSummary::FullReport() const {
  std::ostringstream out;
  for (size_t i = 0; i < transfers.size(); ++i) {
    out << (i > 0 ? "\n" : "") << "Pose " << i + 2 << ", the geodesic to it\n"
        << geodesics[i].FullReport() << "\nPose " << i + 2 << ", its transfer\n"
        << transfers[i].FullReport();
  }
  return out.str();
}

std::string PoseTransferSummary::ToJson() const {
  nlohmann::ordered_json json;
  json["converged"] = Converged();
  json["poses"] = nlohmann::ordered_json::array();
  for (size_t i = 0; i < transfers.size(); ++i) {
    json["poses"].push_back({{"geodesic", nlohmann::ordered_json::parse(geodesics[i].ToJson())},
                             {"transfer", Json(transfers[i])}});
  }
  return json.dump(2) + "\n";
}

}  // namespace shapespace
