#include "support/inspect_path.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <vector>

#include <shapespace/analysis/deviation_sites.h>
#include <shapespace/analysis/internal/summary_fields.h>
#include <shapespace/analysis/path_intersections.h>
#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/base/internal/printable.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/path.h>
#include <shapespace/path/path_file.h>
#include <shapespace/summary/internal/json_of.h>

namespace shapespace::tools {
namespace {

// Limits of printed lists.
constexpr size_t kMaxSites = 8, kMaxParts = 4;
constexpr double kMinSite = 0.001;  // as a share of all deviation

void PrintParts(const RigidParts& parts, Telling* told) {
  const auto count = static_cast<int>(parts.parts.size());
  told->Say("  parts        %d move nearly rigidly; %.3g%% of the surface is joint\n", count,
            100 * parts.joint_share);
  if (count == 0) return;
  told->Say("    part  vertices    area  off a rigid motion, rms   edges, rms  turns against 1\n");
  for (int i = 0; i < count; ++i) {
    const RigidPart& part = parts.parts[i];
    told->Say("    %4d  %8d  %5.3g%%  %-8.3g (%.3g%% of size)", i + 1, part.num_vertices,
              100 * part.area_share, part.residual, 100 * part.relative_residual);
    told->Say("  %9.3g%%  %.1f degrees\n", 100 * part.edge_deviation, part.turn);
  }
}

// Prints the regions with the largest deviation of edges from the first pose.
void PrintDeviation(const std::vector<DeviationSite>& sites, Telling* told) {
  if (sites.empty()) {
    told->Say("  deviation    none: all edges keep the lengths of the first pose\n");
    return;
  }
  told->Say("  deviation    of edge lengths from the first pose: where most of its square is\n");
  told->Say("    share  of area   up to    vertex  at                              parts\n");
  for (size_t i = 0; i < std::min(sites.size(), kMaxSites); ++i) {
    const DeviationSite& site = sites[i];
    if (site.share < kMinSite) break;
    char position[80];
    std::snprintf(position, sizeof(position), "%.4g, %.4g, %.4g", site.position.x(),
                  site.position.y(), site.position.z());
    std::string touched;
    for (size_t k = 0; k < std::min(site.parts.size(), kMaxParts); ++k) {
      touched += (k == 0 ? "" : ", ") + std::to_string(site.parts[k] + 1);
    }
    told->Say("    %4.1f%%   %5.2f%%  %5.1f%%  %8d  %-30s  %s\n", 100 * site.share,
              100 * site.area_share, 100 * site.largest, site.vertex + 1, position,
              touched.empty() ? "-" : touched.c_str());
  }
}

}  // namespace

Json InspectPath(const std::string& file, Telling* told) {
  const Path path = ReadPath(file);
  const Connectivity& connectivity = *path.metric->connectivity;
  const PathQuality quality = MeasureQuality(path);
  const std::string beyond =
      path.extrapolated > 0 ? ", " + std::to_string(path.extrapolated) + " extrapolated" : "";
  told->Say("%s\n  %d shapes, %d of them given%s; %d vertices, %d triangles\n",
            internal::Printable(file).c_str(), path.NumShapes(),
            static_cast<int>(path.poses.size()), beyond.c_str(), connectivity.NumVertices(),
            connectivity.NumTriangles());
  told->Say("  made by      %s\n", internal::Printable(path.provenance).c_str());
  told->Say("  metric       %s; unit of length %.6g\n",
            internal::Printable(DescribeMetric(path.metric->options)).c_str(), path.metric->unit);
  if (!path.converged) told->Say("  solve        NOT CONVERGED, or stopped\n");
  if (quality.inner_shapes > 0) {
    told->Say(
        "  edges        rms %.4g%%, 99th percentile %.4g%%, max %.4g%% from the expected lengths\n",
        100 * quality.edge_rms, 100 * quality.edge_p99, 100 * quality.edge_max);
    told->Say(
        "  roughness    %s; folds %.4g per inner shape\n",
        internal::IfComputed(quality.roughness, internal::Format("%.4g degrees", quality.roughness))
            .c_str(),
        quality.folds);
  }
  if (path.extrapolated > 0) {
    told->Say(
        "  edges        rms %.4g%%, 99th percentile %.4g%%, max %.4g%% from the lengths in the "
        "first shape\n",
        100 * quality.first_rms, 100 * quality.first_p99, 100 * quality.first_max);
  }
  const PathIntersections crossings = MeasureIntersections(path);
  told->Say("  crossings    pairs of triangles: poses up to %" PRId64, crossings.poses_max);
  if (crossings.inner_max >= 0) {
    told->Say("; %s shapes %.4g, up to %" PRId64 "; %.4g beyond the poses",
              path.extrapolated > 0 ? "other" : "inner", crossings.inner_mean, crossings.inner_max,
              crossings.beyond_poses);
  }
  told->Say("\n");
  const RigidParts parts = FindRigidParts(path);
  const std::vector<DeviationSite> sites = FindDeviationSites(path, parts);
  PrintDeviation(sites, told);
  PrintParts(parts, told);
  Json json = {{"file", file},
               {"kind", "path"},
               {"made_by", path.provenance},
               {"vertices", connectivity.NumVertices()},
               {"triangles", connectivity.NumTriangles()},
               {"shapes", path.NumShapes()},
               {"poses", path.poses.size()},
               {"extrapolated", path.extrapolated},
               {"metric", DescribeMetric(path.metric->options)},
               {"unit", path.metric->unit},
               {"converged", path.converged},
               {"quality", internal::JsonOf(quality)},
               {"intersections", internal::JsonOf(crossings)},
               {"joint_share", parts.joint_share}};
  json["parts"] = Json::array();
  for (const RigidPart& part : parts.parts) {
    json["parts"].push_back({{"vertices", part.num_vertices},
                             {"area_share", part.area_share},
                             {"centre", ListOf(part.centre)},
                             {"residual", part.residual},
                             {"relative_residual", part.relative_residual},
                             {"edge_deviation", part.edge_deviation},
                             {"turn", part.turn}});
  }
  json["deviation_sites"] = Json::array();
  for (const DeviationSite& site : sites) {
    std::vector<int> touched;
    for (const int touching : site.parts) touched.push_back(touching + 1);
    json["deviation_sites"].push_back({{"vertex", site.vertex + 1},
                                       {"position", ListOf(site.position)},
                                       {"largest", site.largest},
                                       {"share", site.share},
                                       {"area_share", site.area_share},
                                       {"parts", touched}});
  }
  return json;
}

}  // namespace shapespace::tools
