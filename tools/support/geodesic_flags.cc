#include "support/geodesic_flags.h"

#include <gflags/gflags.h>

#include <shapespace/geodesic/internal/option_fields.h>

#include "support/files.h"
#include "support/flag_group.h"
#include "support/memory_flag.h"
#include "support/metric_flags.h"
#include "support/option_flags.h"
#include "support/tool.h"

static const shapespace::tools::OptionFlags<shapespace::GeodesicOptions> geodesic_flags(
    __FILE__, {{"shapes", "shapes"},
               {"tolerance", "tolerance"},
               {"max_iterations", "max_iterations"},
               {"solver", "solver"},
               {"schedule", "schedule"},
               {"start", "start"},
               {"coarsest", "coarsest"},
               {"avoid_contact", "avoid_contact"}});
FLAG_GROUP(geodesic, "Path", "avoid_contact, shapes, tolerance");

namespace shapespace::tools {

GeodesicOptions GeodesicFromFlags() {
  GeodesicOptions options;
  options.metric = MetricFromFlags();
  options.memory_limit = 1e9 * FLAGS_memory_limit;
  geodesic_flags.Set(&options);
  return options;
}

std::int64_t NumShapes(size_t poses, const GeodesicOptions& options) {
  return (static_cast<std::int64_t>(poses) - 1) * (options.shapes + std::int64_t{1}) + 1;
}

bool IsOnePath(const std::vector<std::string>& files, const std::string& own) {
  if (!IsPathAlone(files)) return false;
  RefuseFlags({"geodesic", "metric"}, {"stiffeners", "loose_components"},
              "goes with poses; " + files[0] + " is solved already and contains its metric", own);
  return true;
}

}  // namespace shapespace::tools
