#include "support/spline_flags.h"

#include <string>

#include <gflags/gflags.h>

#include <shapespace/spline/internal/option_fields.h>

#include "support/flag_group.h"
#include "support/lists.h"
#include "support/option_flags.h"
#include "support/tool.h"

DEFINE_string(
    spline, "",
    "move smoothly through three or more poses, without jumps of velocity; clamped begins "
    "and ends at rest, periodic goes on from the last pose to the first (natural, "
    "not_a_knot, clamped, periodic)");
DEFINE_string(
    times, "",
    "with --spline: when the poses are met, ascending and separated by commas; for "
    "periodic splines one more, when the first pose is met again; or 'length', for times in "
    "proportion to the lengths of the geodesics between the poses; default: evenly spaced");
static const shapespace::tools::OptionFlags<shapespace::SplineOptions> spline_flags(
    __FILE__, {{"hold_limit", "hold_limit"}});
FLAG_GROUP(spline, "Path", "spline");

namespace shapespace::tools {

std::optional<SplineOptions> SplineFromFlags(int num_vertices) {
  if (FLAGS_spline.empty()) {
    RefuseFlags({}, {"times", "hold_limit"}, "goes with --spline");
    return {};
  }
  SplineOptions options;
  options.ends = EnumFromFlag<SplineEnds>("spline", FLAGS_spline);
  options.by_length = FLAGS_times == "length";
  if (!FLAGS_times.empty() && !options.by_length) {
    options.times = NumbersFromFlag("times", FLAGS_times);
  }
  if (options.ends == SplineEnds::kClamped) {
    options.first_velocity = options.last_velocity = Tangent::Zero(3, num_vertices);
  }
  spline_flags.Set(&options);
  return options;
}

}  // namespace shapespace::tools
