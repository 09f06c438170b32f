#include "support/correspondence_flags.h"

#include <algorithm>
#include <utility>

#include <shapespace/correspondence/internal/option_fields.h>
#include <shapespace/correspondence/landmark_file.h>
#include <shapespace/correspondence/marker_file.h>

#include "support/console.h"
#include "support/flag_group.h"
#include "support/lists.h"
#include "support/memory_flag.h"
#include "support/option_flags.h"
#include "support/tool.h"

DEFINE_string(markers, "",
              "text file of corresponding vertices: in each line a vertex of the template (the "
              "source) and one of the target, by number from 1 or by the name of a group. Or two "
              "files of landmarks, the template's and the target's, separated by a comma: .fcsv or "
              ".mrk.json of 3D Slicer, or text with x y z in each line");
DEFINE_string(
    markers_out, "",
    "a file for the markers that were used, up to 40 found ones among them: look at them, mend "
    "one, and name the file with --markers");
DEFINE_bool(soft_markers, false,
            "do not meet markers exactly, for landmarks that are some millimetres off");
DEFINE_bool(hold_all_markers, false, "use all markers, including those that contradict the others");
static const shapespace::tools::OptionFlags<shapespace::CorrespondenceOptions> fit_flags(
    __FILE__, {{"proportions", "proportions"}, {"find_markers", "find_markers"}});
FLAG_GROUP(correspondence, "Correspondence", "markers");

namespace shapespace::tools {

std::vector<std::string> MarkerFilesFromFlag() {
  std::vector<std::string> files = Split(FLAGS_markers);
  const bool has_empty = std::find(files.begin(), files.end(), "") != files.end();
  if (files.size() > 2 || (files.size() == 2 && has_empty)) {
    throw UsageError("--markers: name one file of pairs of vertices, or two files of landmarks");
  }
  return files;
}

std::vector<CorrespondenceMarker> ReadMarkersAndTell(const Poses& template_mesh,
                                                     const Poses& target) {
  const std::vector<std::string> files = MarkerFilesFromFlag();
  std::vector<CorrespondenceMarker> markers;
  if (files.size() == 1) {
    markers = ReadMarkers(files[0], template_mesh, target);
  } else {
    MatchedLandmarks matched = MatchLandmarks(files[0], files[1], template_mesh, target);
    for (const std::string& warning : matched.warnings) Err() << "warning: " << warning << '\n';
    markers = std::move(matched.markers);
  }
  for (CorrespondenceMarker& marker : markers) marker.soft = FLAGS_soft_markers;
  return markers;
}

FlagOutputs MarkersOutFromFlag() {
  if (FLAGS_markers_out.empty()) return {"markers_out", {}};
  CheckCanBeWritten(FLAGS_markers_out);
  return {"markers_out", {FLAGS_markers_out}};
}

void WriteMarkersAndTell(const CorrespondenceResult& result) {
  if (FLAGS_markers_out.empty()) return;
  WriteMarkers(FLAGS_markers_out, result.markers);
  Out() << "wrote " << FLAGS_markers_out << '\n';
}

CorrespondenceOptions CorrespondenceFromFlags() {
  CorrespondenceOptions options;
  options.drop_doubtful = !FLAGS_hold_all_markers;
  options.memory_limit = 1e9 * FLAGS_memory_limit;
  fit_flags.Set(&options);
  return options;
}

}  // namespace shapespace::tools
