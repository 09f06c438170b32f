#include "support/anchor_flags.h"

#include <cmath>
#include <cstdlib>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/path/anchor.h>

#include "support/flag_group.h"
#include "support/solve_progress.h"
#include "support/summary.h"
#include "support/tool.h"

DEFINE_string(anchor, "",
              "move the shapes rigidly such that a part moves rigidly from pose to pose, or stands "
              "still if the poses have it in the same position: its vertices as JSON, such as "
              "'{\"vertices\": [1, [10, 20]]}' or '{\"ball\": {\"centre\": [0, 0, 0], \"radius\": "
              "2}}', selected in the first shape. Or a list of parts that stand from one pose to "
              "another one, for which the shapes are deformed too: '[{\"select\": {\"ball\": ...}, "
              "\"poses\": [2, 4]}, ...]'");
DEFINE_string(ground, "",
              "move the shapes such that the lowest vertex of each is at this height: axis and "
              "height, such as y=0");
FLAG_GROUP(anchor, "Path", "ground");

namespace shapespace::tools {
namespace {

std::pair<int, double> GroundFromFlag() {
  const std::string& text = FLAGS_ground;
  const size_t axis = text.empty() ? std::string::npos : std::string("xyz").find(text[0]);
  if (axis != std::string::npos && text.size() > 2 && text[1] == '=') {
    char* end = nullptr;
    const double height = std::strtod(text.c_str() + 2, &end);
    if (*end == '\0' && std::abs(height) <= kLargestCoordinate) {
      return {static_cast<int>(axis), height};
    }
  }
  throw UsageError("--ground " + text + ": must be x, y or z, = and a height, such as y=0");
}

// Whether the text of --anchor is a list of parts, and not a selection.
bool IsList(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string::npos && text[first] == '[';
}

}  // namespace

AnchorFlags AnchorFlags::FromFlags() {
  AnchorFlags anchorage;
  if (IsGiven("ground")) anchorage.ground_ = GroundFromFlag();
  if (!IsGiven("anchor") || IsList(FLAGS_anchor)) return anchorage;
  try {
    anchorage.anchor_ = ReadSelection(FLAGS_anchor);
  } catch (const InvalidOptions& error) {
    throw UsageError("--anchor " + FLAGS_anchor + ": " + error.what());
  }
  return anchorage;
}

void AnchorFlags::Select(const Shape& shape, const Connectivity& connectivity,
                         const Appearance& appearance, size_t num_poses) {
  try {
    if (IsList(FLAGS_anchor)) {
      parts_ = ReadStandingParts(FLAGS_anchor, shape, connectivity, appearance);
      CheckStandingParts(parts_, connectivity.NumVertices(), static_cast<int>(num_poses));
    } else if (anchor_) {
      vertices_ = SelectVertices(*anchor_, shape, connectivity, appearance);
    }
  } catch (const InvalidOptions& error) {
    throw UsageError("--anchor " + FLAGS_anchor + ": " + error.what());
  }
}

void AnchorFlags::Apply(const Path& whole, Path* path) const {
  if (anchor_) {
    Anchor(whole, vertices_, path);
    path->provenance += "; anchored";
  }
  if (!parts_.empty()) {
    const StandingSummary summary =
        HoldStandingParts(whole, parts_, StandingDefaults(), path, SolveProgress({}).get());
    PrintSummary(summary.BriefReport(), summary.warnings, summary.Converged());
    path->provenance += "; standing parts held";
  }
  if (ground_) {
    Ground(path, ground_->first, ground_->second);
    path->provenance += "; on the ground " + FLAGS_ground;
  }
}

}  // namespace shapespace::tools
