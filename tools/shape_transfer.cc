// Transfers a motion to another body of the same connectivity.

#include <optional>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/correspondence/correspondence.h>
#include <shapespace/mesh/check.h>
#include <shapespace/output/frames.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/transfer/internal/option_fields.h>
#include <shapespace/transfer/transfer.h>

#include "support/anchor_flags.h"
#include "support/correspondence_flags.h"
#include "support/flag_group.h"
#include "support/geodesic_flags.h"
#include "support/memory_flag.h"
#include "support/mesh_flags.h"
#include "support/option_flags.h"
#include "support/outputs.h"
#include "support/poses.h"
#include "support/report.h"
#include "support/solve_progress.h"
#include "support/stdin_mesh.h"
#include "support/summary.h"
#include "support/telling.h"
#include "support/tool.h"

DEFINE_string(
    target, "",
    "the body to move, in the pose of the first source; the source is fitted onto one with other "
    "faces, as by shape-correspond");
DEFINE_string(hybrids, "",
              "files for the bodies half way between source and target, named as by --output");
static const shapespace::tools::OptionFlags<shapespace::TransferOptions> flags(__FILE__,
                                                                               {{"method",
                                                                                 "method"}});
static const shapespace::tools::OptionFlags<shapespace::LadderOptions> ladder_flags(
    __FILE__, {{"connection", "connection"}, {"scale", "scale"}, {"align", "align"}});
FLAG_GROUP(transfer, "Transfer", "target, method");

namespace shapespace::tools {
namespace {

// Each shape of a geodesic is a rung of the ladder, which takes as long as a small geodesic.
constexpr char kShapes[] = "7";

// Refuses flags that would have no effect.
void CheckFlagsOfTheLadder(bool climbs) {
  if (climbs) return;
  RefuseFlags({"geodesic", "metric"}, {"connection"}, "goes with --method ladder", "avoid_contact");
  if (FLAGS_hybrids.empty()) {
    RefuseFlags({}, {"scale", "align"}, "goes with --method ladder or --hybrids");
  }
}

TransferOptions TransferFromFlags() {
  TransferOptions options;
  options.hybrids = !FLAGS_hybrids.empty();
  options.memory_limit = 1e9 * FLAGS_memory_limit;
  flags.Set(&options);
  CheckFlagsOfTheLadder(options.method == TransferMethod::kLadder);
  ladder_flags.Set(&options.ladder);
  return options;
}

// A target of another connectivity, represented by the source that is fitted onto it.
class OtherMesh {
 public:
  // `source` is a mesh of the source's connectivity, in its first pose.
  explicit OtherMesh(const Poses& source)
      : target_(ReadMeshesFromFlags({FLAGS_target})),
        fit_(Correspond(source.connectivity, source.shapes[0], target_.connectivity,
                        target_.shapes[0], Markers(source, target_), CorrespondenceFromFlags(),
                        SolveProgress({}, "transferring").get())) {
    PrintSummary(fit_.summary.BriefReport(), fit_.summary.warnings, fit_.summary.Converged());
  }

  const Poses& Target() const { return target_; }
  const CorrespondenceResult& Fit() const { return fit_; }
  // The motion of the fitted source as a motion of the target's own mesh.
  Path Carry(const Path& path) const {
    return CarryPath(fit_, path, target_.connectivity, target_.shapes[0]);
  }

 private:
  static std::vector<CorrespondenceMarker> Markers(const Poses& source, const Poses& target) {
    if (FLAGS_markers.empty()) return {};
    return ReadMarkersAndTell(source, target);
  }

  const Poses target_;
  const CorrespondenceResult fit_;
};

// A path's first shape, in the form of a file that was read.
Poses FirstShapeOf(const Path& path, const std::string& file) {
  Poses poses;
  poses.connectivity = path.metric->connectivity;
  poses.shapes = {path.Placed(0)};
  poses.names = {file};
  poses.soup = FrameSoup(*poses.connectivity, path.appearance);
  poses.soup.vertices = poses.shapes[0];
  return poses;
}

// Whether the source, whose first pose or path is `file`, is fitted onto the target: if markers are
// given or looked for, or the target has other numbers of vertices or faces. If the faces alone
// differ, it was probably exported in another order, and is refused.
bool IsFitted(const Soup& source, const std::string& file) {
  if (!FLAGS_markers.empty() || CorrespondenceFromFlags().find_markers) return true;
  for (const Finding& finding : CheckSameMesh(source, ReadSoupOrStdin(FLAGS_target))) {
    if (!finding.different_meshes || finding.kind == "polygons-differ") continue;
    Note(FLAGS_target, " has other faces than ", file, ", which is fitted onto it");
    return true;
  }
  return false;
}

// Refuses flags that have no effect, or none that is known, for a source that is fitted or not.
void CheckFlagsOfTheFit(bool fitted) {
  if (fitted) {
    RefuseFlags({}, {"hybrids", "stiffeners"}, "does not go with a target of other faces");
  } else {
    RefuseFlags({"correspondence"}, {}, "goes with a target of other faces");
  }
}

void WriteReports(const std::string& text, const std::string& json,
                  const std::optional<OtherMesh>& other) {
  if (!other) return WriteReport(text, json);
  const CorrespondenceSummary& fit = other->Fit().summary;
  Json report = Json::parse(json);
  report["correspondence"] = Json::parse(fit.ToJson());
  WriteReport(fit.FullReport() + '\n' + text, internal::TextOf(report));
}

// The poses of the files, and after them the target.
Poses ReadWithTarget(const std::vector<std::string>& files) {
  std::vector<Soup> soups;
  for (const std::string& file : files) {
    for (Soup& pose : ReadSoupsOrStdin(file)) soups.push_back(std::move(pose));
  }
  if (soups.size() < 2) {
    throw UsageError(files[0] + " has one pose; name at least two poses of one mesh");
  }
  soups.push_back(ReadSoupOrStdin(FLAGS_target));
  return MakePosesFromFlags(std::move(soups));
}

void Run(const std::vector<std::string>& files) {
  const bool from_path = IsOnePath(files, "avoid_contact");
  if (FLAGS_target.empty()) throw UsageError("--target: name the body to move");
  const GeodesicOptions geodesic = GeodesicFromFlags();
  TransferOptions options = TransferFromFlags();
  options.avoid_contact = geodesic.avoid_contact;
  const std::vector<std::string> outputs = OutputsFromFlags();
  AnchorFlags anchorage = AnchorFlags::FromFlags();
  std::vector<std::string> hybrid_outputs;
  if (!FLAGS_hybrids.empty()) hybrid_outputs = OutputsFromFlag("hybrids", FLAGS_hybrids);
  CorrespondenceFromFlags();
  MarkerFilesFromFlag();
  std::optional<OtherMesh> other;
  std::vector<std::string> all = files;
  all.push_back(FLAGS_target);
  const auto check = [&](std::int64_t frames) {
    std::vector<std::string> inputs = WithStiffeners(all);
    if (!FLAGS_markers.empty()) {
      for (const std::string& markers : MarkerFilesFromFlag()) inputs.push_back(markers);
    }
    CheckNothingIsOverwritten(inputs, {{"output", outputs, frames},
                                       {"hybrids", hybrid_outputs, frames},
                                       MarkersOutFromFlag(),
                                       ReportFromFlag()});
  };
  std::vector<std::string> all_outputs = outputs;
  all_outputs.insert(all_outputs.end(), hybrid_outputs.begin(), hybrid_outputs.end());
  const auto finish = [&](auto result, const std::vector<std::string>& warnings,
                          const Appearance& appearance) {
    PrintSummary(result.summary.BriefReport(), warnings, result.summary.Converged());
    if (other) result.path = other->Carry(result.path);
    result.path.provenance = Provenance("shape-transfer", all);
    result.hybrids.provenance = result.path.provenance + "; hybrids";
    result.path.appearance = result.hybrids.appearance = appearance;
    anchorage.Apply(&result.path);
    if (!hybrid_outputs.empty()) anchorage.Apply(&result.hybrids);
    WriteOutputs(outputs, result.path, result.path);
    if (!hybrid_outputs.empty()) WriteOutputs(hybrid_outputs, result.hybrids, result.hybrids);
    if (other) WriteMarkersAndTell(other->Fit());
    WriteReports(result.summary.FullReport(), result.summary.ToJson(), other);
  };
  if (from_path) {
    const Path source = ReadPathAndTell(files[0]);
    check(source.NumShapes());
    const Poses first = FirstShapeOf(source, files[0]);
    const bool fitted = IsFitted(first.soup, files[0]);
    CheckFlagsOfTheFit(fitted);
    if (fitted) other.emplace(first);
    const Poses target = other ? other->Target() : ReadPoseOf(source, files[0], FLAGS_target);
    anchorage.Select(target.shapes[0], *target.connectivity, target.soup.appearance,
                     source.poses.size());
    TransferResult result = Transfer(source, other ? other->Fit().fitted : target.shapes[0],
                                     options, SolveProgress(all_outputs).get());
    const std::vector<std::string> warnings = result.summary.warnings;
    finish(std::move(result), warnings, target.soup.appearance);
  } else {
    const bool fitted = IsFitted(ReadSoupOrStdin(files[0]), files[0]);
    CheckFlagsOfTheFit(fitted);
    Poses poses = fitted ? ReadPosesFromFlags(files) : ReadWithTarget(files);
    check(static_cast<std::int64_t>(poses.shapes.size()));
    Shape target;
    Appearance appearance;
    if (!fitted) {
      target = poses.shapes.back();
      poses.shapes.pop_back();
      appearance = ReadSoupOrStdin(FLAGS_target).appearance;
      anchorage.Select(target, *poses.connectivity, appearance, poses.shapes.size());
    } else {
      other.emplace(poses);
      target = other->Fit().fitted;
      appearance = other->Target().soup.appearance;
      anchorage.Select(other->Target().shapes[0], *other->Target().connectivity, appearance,
                       poses.shapes.size());
    }
    PoseTransferResult result = TransferPoses(poses.connectivity, poses.shapes, target, geodesic,
                                              options, SolveProgress(all_outputs).get());
    const std::vector<std::string> warnings = result.summary.Warnings();
    finish(std::move(result), warnings, appearance);
  }
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  gflags::SetCommandLineOptionWithMode("shapes", kShapes, gflags::SET_FLAGS_DEFAULT);
  return RunTool(
      argc, argv,
      {"shape-transfer",
       "deformation transfer: the same motion of another body",
       std::string(
           R"(  shape-transfer stand.obj sit.obj leap.obj --target other.obj --output moved%d.obj
  shape-transfer walk.path --target other.obj --output walk.glb --hybrids half.glb
  shape-transfer cat0.obj cat1.obj --target lion.obj --output lion%d.obj

The sources must have the same faces in the same order. If the target has other numbers of vertices
or faces, or --markers or --find_markers are given, the source is fitted onto it, as by
shape-correspond, and outputs have the target's faces; the report says how sure the fit is.
The target is in the first pose; frame 0 is the target, frame 1 the target in the second pose, and
so on. For a .path there is one frame per shape. With --method ladder the geodesic to each pose has
--shapes + 1 segments, each of which is transferred; the flags of the metric are those of these
geodesics. In a film strip the target is blue, its other shapes are purple, hybrids are green.)") +
           kHowASolveEnds,
       {"transfer", "geodesic", "report", "summary", "outputs", "camera", "bones", "metric",
        "poses", "mesh", "memory", "anchor", "correspondence", "outside_files"}},
      Run);
}
