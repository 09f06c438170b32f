#include <shapespace/geodesic/geodesic.h>

#include <algorithm>
#include <memory>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/cost/internal/refuse_sums.h>
#include <shapespace/files/display_names.h>
#include <shapespace/geodesic/detail/align_folds.h>
#include <shapespace/geodesic/detail/geodesic_levels.h>
#include <shapespace/geodesic/internal/memory.h>
#include <shapespace/mesh/different_meshes.h>
#include <shapespace/path/align.h>
#include <shapespace/summary/internal/check_options.h>
#include <shapespace/summary/internal/memory.h>

namespace shapespace {
namespace {

// Fails early if the finest level cannot be solved.
void CheckFinest(const Metric& metric, double bytes, const GeodesicOptions& options) {
  if (options.solver == GeodesicSolver::kTrustRegion) cost::RefuseDenseRows(metric);
  internal::CheckMemory("this solve", bytes, options.memory_limit, "insert fewer shapes");
}

void CheckShape(const Shape& shape, const Metric& metric) {
  const int vertices = metric.connectivity->NumVertices();
  if (shape.cols() != vertices) {
    throw MeshError(internal::OfOtherMesh("a pose", shape.cols(), vertices));
  }
  if (!shape.allFinite()) throw MeshError("a pose has a coordinate that is not finite");
}

}  // namespace

void GeodesicOptions::Validate() const {
  metric.Validate();
  if (shapes < 1) throw InvalidOptions("shapes", "must be 1 or more");
  internal::CheckTolerance(tolerance);
  internal::CheckMaxIterations(max_iterations);
  internal::CheckMemoryLimit(memory_limit);
  if (!via.empty() && !avoid_contact) {
    throw InvalidOptions("via", "is for paths that avoid contact: set avoid_contact");
  }
  internal::CheckObstacle(obstacle, avoid_contact);
}

GeodesicResult Interpolate(const Poses& poses, const GeodesicOptions& options, Progress* progress) {
  GeodesicResult result = Interpolate(poses.connectivity, poses.shapes, options, progress);
  result.path.appearance = poses.soup.appearance;
  for (const std::string& name : poses.names) result.path.pose_names.push_back(DisplayName(name));
  return result;
}

GeodesicResult Interpolate(const std::shared_ptr<const Connectivity>& connectivity,
                           const std::vector<Shape>& poses, const GeodesicOptions& options,
                           Progress* progress) {
  options.Validate();
  if (poses.size() < 2) throw MeshError("a geodesic needs at least two poses");
  const internal::Stopwatch freezing;
  ReportProgress(progress, "freezing the metric", 0, 0);
  const auto metric = FreezeMetric(options.metric, connectivity, poses);
  const double freeze_seconds = freezing.Seconds();
  GeodesicResult result = Interpolate(metric, poses, options, progress);
  result.summary.freeze_seconds = freeze_seconds;
  result.summary.total_seconds += freeze_seconds;
  return result;
}

GeodesicResult Interpolate(const std::shared_ptr<const Metric>& metric,
                           const std::vector<Shape>& poses, const GeodesicOptions& options,
                           Progress* progress) {
  options.Validate();
  if (poses.size() < 2) throw MeshError("a geodesic needs at least two poses");
  if (!options.via.empty() && poses.size() > 2) throw InvalidOptions("via", "is for two poses");
  std::vector<Shape> shapes = poses;
  shapes.insert(shapes.end() - 1, options.via.begin(), options.via.end());
  for (const Shape& shape : shapes) CheckShape(shape, *metric);
  const int count = static_cast<int>(shapes.size());
  const double bytes =
      internal::GeodesicBytes(*metric, count, internal::MostShapes(*metric, count - 1, options));
  CheckFinest(*metric, bytes, options);
  const internal::Stopwatch total;
  ReportProgress(progress, "decimating", 0, 0);
  const AlignedPoses aligned = internal::AlignFolds(*metric, AlignPoses(*metric, shapes));
  const internal::GeodesicLevels levels(metric, aligned.shapes, PosePairs::kConsecutive, options,
                                        progress);
  const double hierarchy_seconds = total.Seconds();
  GeodesicResult result = levels.Solve(aligned, progress);
  result.summary.hierarchy_seconds = hierarchy_seconds;
  result.summary.estimated_bytes = bytes;
  result.summary.total_seconds = total.Seconds();
  return result;
}

Interpolator::Interpolator(const std::shared_ptr<const Connectivity>& connectivity,
                           const std::vector<Shape>& poses, const GeodesicOptions& options) {
  options.Validate();
  if (!options.via.empty()) throw InvalidOptions("via", "is for one path between two poses");
  if (options.obstacle) {
    throw InvalidOptions("obstacle", "is for one path: shapes of an Interpolator have no place");
  }
  const auto metric = FreezeMetric(options.metric, connectivity, poses, 0, PosePairs::kAll);
  const double pose_bytes = 2.0 * sizeof(double) * poses.size() * poses.front().size();
  const int most_shapes = internal::MostShapes(*metric, 1, options);
  estimated_bytes_ = internal::GeodesicBytes(*metric, 2, most_shapes) + pose_bytes;
  CheckFinest(*metric, estimated_bytes_, options);
  const double left = options.memory_limit - estimated_bytes_;
  constexpr double kMostThreads = 1e6;
  most_at_once_ =
      1 + static_cast<int>(std::clamp(left / internal::FurtherGeodesicBytes(*metric, most_shapes),
                                      0.0, kMostThreads));
  levels_ = std::make_unique<internal::GeodesicLevels>(metric, AlignPoses(*metric, poses).shapes,
                                                       PosePairs::kAll, options);
}

Interpolator::~Interpolator() = default;
Interpolator::Interpolator(Interpolator&&) noexcept = default;
Interpolator& Interpolator::operator=(Interpolator&&) noexcept = default;

const std::shared_ptr<const Metric>& Interpolator::GetMetric() const {
  return levels_->GetMetric();
}

int Interpolator::MostAtOnce() const { return most_at_once_; }

GeodesicResult Interpolator::Between(const Shape& from, const Shape& to, Progress* progress) const {
  CheckShape(from, *GetMetric());
  CheckShape(to, *GetMetric());
  const internal::Stopwatch total;
  const AlignedPoses aligned =
      internal::AlignFolds(*GetMetric(), AlignPoses(*GetMetric(), {from, to}));
  GeodesicResult result = levels_->Solve(aligned, progress);
  result.summary.estimated_bytes = estimated_bytes_;
  result.summary.total_seconds = total.Seconds();
  return result;
}

}  // namespace shapespace
