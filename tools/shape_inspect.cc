// Prints the contents of meshes, paths and spaces, and whether meshes correspond.

#include <algorithm>
#include <cinttypes>
#include <cstdio>

#include <gflags/gflags.h>
#include <Eigen/Geometry>

#include <shapespace/analysis/deviation_sites.h>
#include <shapespace/analysis/intersections.h>
#include <shapespace/analysis/path_intersections.h>
#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/base/internal/printable.h>
#include <shapespace/exploration/space_file.h>
#include <shapespace/files/read.h>
#include <shapespace/mesh/check.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/align.h>
#include <shapespace/path/energy.h>
#include <shapespace/path/path_file.h>
#include <shapespace/statistics/modes_file.h>

#include "support/mesh_flags.h"
#include "support/metric_flags.h"
#include "support/outside_files_flag.h"
#include "support/tool.h"

namespace shapespace::tools {
namespace {

// Limits of printed lists.
constexpr size_t kMaxSites = 8, kMaxParts = 4;
constexpr int kMaxModes = 6;
constexpr double kMinSite = 0.001;  // as a share of all deviation

const char* Name(Severity severity) {
  switch (severity) {
    case Severity::kNote:
      return "note";
    case Severity::kWarning:
      return "warning";
    case Severity::kNonManifold:
      return "non-manifold";
    case Severity::kFatal:
      break;
  }
  return "fatal";
}

// Returns whether no finding is worse than a warning.
bool Print(const std::vector<Finding>& findings) {
  bool good = true;
  for (const Finding& finding : findings) {
    Severity severity = finding.severity;
    if (severity == Severity::kNonManifold && FLAGS_allow_nonmanifold)
      severity = Severity::kWarning;
    const bool acceptable = severity <= Severity::kWarning;
    std::printf("  %-12s %-24s %s%s\n", Name(severity), finding.kind.c_str(),
                internal::Printable(finding.message).c_str(),
                acceptable ? "" : InFlags(finding.option).c_str());
    good = good && acceptable;
  }
  return good;
}

std::string NameOf(const Soup& soup) {
  return internal::Printable(soup.name.empty() ? soup.file : soup.file + ":" + soup.name);
}

void PrintContent(const Soup& soup) {
  std::printf("%s\n  %d vertices, %d polygons, %zu segments", NameOf(soup).c_str(),
              soup.NumVertices(), soup.NumPolygons(), soup.segments.size());
  if (soup.NumVertices() > 0) {
    const Eigen::Vector3d size =
        soup.vertices.rowwise().maxCoeff() - soup.vertices.rowwise().minCoeff();
    std::printf(", extent %.6g x %.6g x %.6g", size.x(), size.y(), size.z());
  }
  std::printf("\n");
  for (const std::string& what : soup.dropped) {
    std::printf("  %-12s %-24s %s\n", Name(Severity::kNote), "not-kept",
                internal::Printable(what).c_str());
  }
}

// Prints self-intersections of a usable mesh.
void PrintIntersections(const Soup& soup) {
  const auto connectivity = ConnectivityOf(soup, {soup.vertices});
  const std::int64_t pairs = CountIntersections(*connectivity, soup.vertices);
  const std::string message = std::to_string(pairs) + " pairs of triangles cross";
  std::printf("  %-12s %-24s %s\n", Name(Severity::kNote), "self-intersections",
              pairs == 0 ? "none" : message.c_str());
}

// Prints the difference of a pose from the first, up to rigid motion.
void PrintDistance(const Soup& reference, const Soup& pose) {
  const std::vector<Shape> pair = {reference.vertices, pose.vertices};
  const auto connectivity = ConnectivityOf(reference, pair);
  CheckMetricFlags(*connectivity);
  const auto metric = FreezeMetric(MetricFromFlags(), connectivity, pair);
  const AlignedPoses aligned = AlignPoses(*metric, pair);
  const Shape &first = aligned.shapes[0], &other = aligned.shapes[1];
  const Eigen::RowVectorXd squared = (other - first).colwise().squaredNorm();
  std::vector<double> stretch;
  for (int e = 0; e < connectivity->NumEdges(); ++e) {
    const Eigen::Vector2i v = connectivity->Edges().col(e);
    const double length = (first.col(v(1)) - first.col(v(0))).norm();
    if (length > 0) {
      stretch.push_back(std::abs((other.col(v(1)) - other.col(v(0))).norm() / length - 1));
    }
  }
  if (stretch.empty()) return;
  std::sort(stretch.begin(), stretch.end());
  std::printf("%s against %s\n", NameOf(pose).c_str(), NameOf(reference).c_str());
  std::printf("  turned by            %.4g degrees\n",
              Eigen::AngleAxisd(aligned.motions[1].rotation).angle() * 180 / M_PI);
  std::printf(
      "  vertices apart       rms %.4g, max %.4g (user's units, once aligned)\n",
      metric->unit * std::sqrt(squared.dot(metric->vertex_area) / metric->vertex_area.sum()),
      metric->unit * std::sqrt(squared.maxCoeff()));
  std::printf("  edges stretched by   median %.3g%%, 99th percentile %.3g%%, max %.3g%%\n",
              100 * stretch[stretch.size() / 2], 100 * stretch[(stretch.size() - 1) * 99 / 100],
              100 * stretch.back());
  const double bound = ScaledEnergy(EnergyLowerBound(*metric, first, other, 1000), 1000);
  if (std::isfinite(bound)) {
    std::printf("  distance             at least %.6g (%s)\n", std::sqrt(bound),
                DescribeMetric(metric->options).c_str());
  }
}

void PrintParts(const RigidParts& parts) {
  std::printf("  parts        %zu move nearly rigidly; %.3g%% of the surface is joint\n",
              parts.parts.size(), 100 * parts.joint_share);
  if (parts.parts.empty()) return;
  std::printf(
      "    part  vertices    area  off a rigid motion, rms   edges, rms  turns against 1\n");
  for (size_t i = 0; i < parts.parts.size(); ++i) {
    const RigidPart& part = parts.parts[i];
    std::printf("    %4zu  %8d  %5.3g%%  %-8.3g (%.3g%% of size)", i + 1, part.num_vertices,
                100 * part.area_share, part.residual, 100 * part.relative_residual);
    std::printf("  %9.3g%%  %.1f degrees\n", 100 * part.edge_deviation, part.turn);
  }
}

// Prints the regions with the largest deviation of edges from the first pose.
void PrintDeviation(const Path& path, const RigidParts& parts) {
  const std::vector<DeviationSite> sites = FindDeviationSites(path, parts);
  if (sites.empty()) {
    std::printf("  deviation    none: all edges keep the lengths of the first pose\n");
    return;
  }
  std::printf("  deviation    of edge lengths from the first pose: where most of its square is\n");
  std::printf("    share  of area   up to    vertex  at                              parts\n");
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
    std::printf("    %4.1f%%   %5.2f%%  %5.1f%%  %8d  %-30s  %s\n", 100 * site.share,
                100 * site.area_share, 100 * site.largest, site.vertex + 1, position,
                touched.empty() ? "-" : touched.c_str());
  }
}

void PrintPath(const std::string& file) {
  const Path path = ReadPath(file);
  const Connectivity& connectivity = *path.metric->connectivity;
  const PathQuality quality = MeasureQuality(path);
  const std::string beyond =
      path.extrapolated > 0 ? ", " + std::to_string(path.extrapolated) + " extrapolated" : "";
  std::printf("%s\n  %d shapes, %zu of them given%s; %d vertices, %d triangles\n",
              internal::Printable(file).c_str(), path.NumShapes(), path.poses.size(),
              beyond.c_str(), connectivity.NumVertices(), connectivity.NumTriangles());
  std::printf("  made by      %s\n", internal::Printable(path.provenance).c_str());
  std::printf("  metric       %s; unit of length %.6g\n",
              internal::Printable(DescribeMetric(path.metric->options)).c_str(), path.metric->unit);
  if (!path.converged) std::printf("  solve        NOT CONVERGED, or stopped\n");
  if (quality.inner_shapes > 0) {
    std::printf(
        "  edges        rms %.4g%%, 99th percentile %.4g%%, max %.4g%% from the expected lengths\n",
        100 * quality.edge_rms, 100 * quality.edge_p99, 100 * quality.edge_max);
    std::printf("  roughness    %.4g degrees; folds %.4g per inner shape\n", quality.roughness,
                quality.folds);
  }
  if (path.extrapolated > 0) {
    std::printf(
        "  edges        rms %.4g%%, 99th percentile %.4g%%, max %.4g%% from the lengths in the "
        "first shape\n",
        100 * quality.first_rms, 100 * quality.first_p99, 100 * quality.first_max);
  }
  const PathIntersections crossings = MeasureIntersections(path);
  std::printf("  crossings    pairs of triangles: poses up to %" PRId64
              "; %s shapes %.4g, up to %" PRId64 "; %.4g beyond the poses\n",
              crossings.poses_max, path.extrapolated > 0 ? "other" : "inner", crossings.inner_mean,
              crossings.inner_max, crossings.beyond_poses);
  const RigidParts parts = FindRigidParts(path);
  PrintDeviation(path, parts);
  PrintParts(parts);
}

void PrintSpace(const std::string& file) {
  const PoseSpace space = ReadSpace(file);
  std::printf("%s\n", internal::Printable(file).c_str());
  if (!space.provenance.empty())
    std::printf("  made by      %s\n", internal::Printable(space.provenance).c_str());
  std::printf("  mesh         %d vertices, %d triangles\n",
              space.metric->connectivity->NumVertices(),
              space.metric->connectivity->NumTriangles());
  std::printf("  metric       %s; unit of length %.6g\n",
              internal::Printable(DescribeMetric(space.metric->options)).c_str(),
              space.metric->unit);
  std::printf("  nodes        %d, of which %d are poses; %d triangles, %d segments\n",
              space.NumNodes(), space.NumPoses(), static_cast<int>(space.triangles.cols()),
              static_cast<int>(space.segments.cols()));
  std::printf("  distances    up to %.4g; stress of the plane %.3g\n", space.distances.maxCoeff(),
              space.stress);
  for (int i = 0; i < space.NumPoses(); ++i) {
    std::printf("  pose         at %12.6g %12.6g  %s\n", space.points(0, i), space.points(1, i),
                internal::Printable(space.names[i]).c_str());
  }
}

void PrintModes(const std::string& file) {
  const PoseModes modes = ReadModes(file);
  std::printf("%s\n", internal::Printable(file).c_str());
  std::printf("  made by      %s\n", internal::Printable(modes.provenance).c_str());
  std::printf("  mesh         %d vertices, %d triangles\n",
              modes.metric->connectivity->NumVertices(),
              modes.metric->connectivity->NumTriangles());
  std::printf("  metric       %s; unit of length %.6g\n",
              internal::Printable(DescribeMetric(modes.metric->options)).c_str(),
              modes.metric->unit);
  std::printf("  poses        %d%s\n", modes.NumPoses(),
              modes.size == PoseSize::kRemove ? ", scaled to the same area" : "");
  std::printf("  modes        %d, with %.3g%% of the variance\n", modes.NumModes(),
              100 * modes.Share(modes.NumModes()));
  const Eigen::MatrixXd coordinates = modes.Coordinates();
  for (int i = 0; i < modes.NumPoses(); ++i) {
    std::printf("  pose         at");
    for (int k = 0; k < std::min(modes.NumModes(), kMaxModes); ++k) {
      std::printf(" %7.3f", coordinates(i, k));
    }
    std::printf("%s  %s\n", modes.NumModes() > kMaxModes ? " ..." : "",
                internal::Printable(modes.names[i]).c_str());
  }
}

// Prints a pose, and compares it with the first one. Returns whether it is usable.
bool PrintMesh(Soup read, std::vector<Soup>* soups) {
  soups->push_back(std::move(read));
  Soup& soup = soups->back();
  PrintContent(soup);
  const bool usable = Print(CheckSoup(soup));
  if (usable) PrintIntersections(soup);
  const char axis = MirrorFromFlags();
  if (usable && soups->size() > 1 && axis != 0 && MirrorBack(soups->front(), axis, &soup)) {
    std::printf("  %-12s %-24s mirrored; its %c has changed sign\n", Name(Severity::kNote),
                "mirrored", axis);
  }
  const bool corresponds = soups->size() == 1 || Print(CheckSameMesh(soups->front(), soup));
  return usable && corresponds;
}

void Run(const std::vector<std::string>& files) {
  if (files.empty()) throw UsageError("name one or more files: meshes, .path, .space or .modes");
  bool usable = true;
  std::vector<Soup> soups;
  // Meshes last, because the comparison of poses follows after them.
  for (const bool meshes : {false, true}) {
    for (const std::string& file : files) {
      const std::string extension = internal::FileExtension(file);
      const bool mesh = extension != ".path" && extension != ".space" && extension != ".modes";
      if (mesh != meshes) continue;
      try {
        if (meshes) {
          for (Soup& pose : ReadSoups(file, FLAGS_allow_outside_files)) {
            usable = PrintMesh(std::move(pose), &soups) && usable;
          }
        } else if (extension == ".path") {
          PrintPath(file);
        } else if (extension == ".space") {
          PrintSpace(file);
        } else {
          PrintModes(file);
        }
      } catch (const Error& error) {
        Complain(error.what() + InFlags(error.option()));
      }
    }
  }
  if (!usable) throw MeshError("not usable as it is: see the findings");
  for (size_t i = 1; i < soups.size(); ++i) PrintDistance(soups[0], soups[i]);
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  return RunTool(argc, argv,
                 {"shape-inspect",
                  "contents of files, correspondence of meshes, differences between poses",
                  "  shape-inspect a.obj b.obj walk.path poses.space herd.modes\n\n"
                  "Exit code 1 if a file cannot be read, a mesh cannot be used as it is, or meshes "
                  "do not\ncorrespond.",
                  {"metric", "mesh", "outside_files"}},
                 Run);
}
