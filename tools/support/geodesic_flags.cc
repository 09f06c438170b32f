#include "support/geodesic_flags.h"

#include <algorithm>

#include <gflags/gflags.h>

#include "support/choose.h"
#include "support/flag_group.h"
#include "support/memory_flag.h"
#include "support/metric_flags.h"
#include "support/outputs.h"
#include "support/tool.h"

DEFINE_int32(shapes, 15, "shapes to insert between neighbouring poses");
DEFINE_double(tolerance, 1e-4,
              "a level has converged when an iteration lowers the energy by less than this share");
DEFINE_int32(max_iterations, 500, "maximum number of iterations per level");
DEFINE_string(solver, "automatic",
              "automatic, lbfgs (Ceres), threaded_lbfgs (shapespace) or trust_region (Ceres)");
DEFINE_string(
    schedule, "automatic",
    "order of resolutions: automatic, paper (space and time in turn) or flat (no hierarchy)");
DEFINE_string(
    start, "best",
    "initial guess of the first solve: blend, first, last, rigid, or the best of the first three");
DEFINE_int32(coarsest, 200, "triangles of the coarsest level of the hierarchy");
FLAG_GROUP(geodesic, "Path");

namespace shapespace::tools {

GeodesicOptions GeodesicFromFlags() {
  GeodesicOptions options;
  options.metric = MetricFromFlags();
  options.shapes = FLAGS_shapes;
  options.tolerance = FLAGS_tolerance;
  options.max_iterations = FLAGS_max_iterations;
  options.memory_limit = 1e9 * FLAGS_memory_limit;
  options.coarsest = FLAGS_coarsest;
  options.solver = Choose<GeodesicSolver>("solver", FLAGS_solver,
                                          {{"automatic", GeodesicSolver::kAutomatic},
                                           {"lbfgs", GeodesicSolver::kLbfgs},
                                           {"threaded_lbfgs", GeodesicSolver::kThreadedLbfgs},
                                           {"trust_region", GeodesicSolver::kTrustRegion}});
  options.schedule = Choose<GeodesicSchedule>("schedule", FLAGS_schedule,
                                              {{"automatic", GeodesicSchedule::kAutomatic},
                                               {"paper", GeodesicSchedule::kPaper},
                                               {"flat", GeodesicSchedule::kFlat}});
  options.start = Choose<GeodesicStart>("start", FLAGS_start,
                                        {{"best", GeodesicStart::kBest},
                                         {"blend", GeodesicStart::kBlend},
                                         {"first", GeodesicStart::kFirst},
                                         {"last", GeodesicStart::kLast},
                                         {"rigid", GeodesicStart::kRigid}});
  options.Validate();
  return options;
}

std::int64_t NumShapes(size_t poses, const GeodesicOptions& options) {
  return (static_cast<std::int64_t>(poses) - 1) * (options.shapes + std::int64_t{1}) + 1;
}

bool IsOnePath(const std::vector<std::string>& files) {
  const bool is_path = std::any_of(files.begin(), files.end(), IsPathFile);
  if (is_path ? files.size() != 1 : files.empty()) {
    throw UsageError("name at least two poses of one mesh, or one .path file alone");
  }
  if (!is_path) return false;
  RefuseFlags({"geodesic", "metric"}, {"stiffeners"},
              "goes with poses; " + files[0] + " is solved already and contains its metric");
  return true;
}

}  // namespace shapespace::tools
