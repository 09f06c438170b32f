#ifndef SHAPESPACE_GEODESIC_DETAIL_GEODESIC_LEVELS_H_
#define SHAPESPACE_GEODESIC_DETAIL_GEODESIC_LEVELS_H_

#include <memory>
#include <mutex>
#include <vector>

#include <shapespace/geodesic/geodesic.h>
#include <shapespace/geodesic/internal/resolution.h>
#include <shapespace/geodesic/internal/workload.h>
#include <shapespace/hierarchy/hierarchy.h>
#include <shapespace/path/align.h>

namespace shapespace::internal {

/// The greatest number of shapes between two neighbours of so many pieces: twice as many as asked
/// for, to remove a jump, unless they need very much memory. The memory limit has no part in this:
/// it refuses solves, and changes no result.
int MostShapes(const Metric& metric, int pieces, const GeodesicOptions& options);

/// The data shared by all solves between poses of one mesh: its levels, and on each the metric and
/// what solves with it need.
class GeodesicLevels {
 public:
  GeodesicLevels(const std::shared_ptr<const Metric>& metric, const std::vector<Shape>& aligned,
                 PosePairs pairs, const GeodesicOptions& options, Progress* progress = nullptr);

  const std::shared_ptr<const Metric>& GetMetric() const { return metric_; }
  /// The path through `poses`. Several threads may solve at a time.
  GeodesicResult Solve(const AlignedPoses& poses, Progress* progress) const;

 private:
  // What one solve at a time works on: each level.
  using Workspace = std::vector<Resolution>;

  HierarchyOptions MakeHierarchyOptions() const;
  // A workspace for a path through these poses: one of an earlier solve, if any is idle.
  Workspace TakeWorkspace(const std::vector<Shape>& aligned) const;
  void GiveBack(Workspace workspace) const;
  void SolvePieces(const AlignedPoses& poses, Progress* progress, Workspace* workspace,
                   GeodesicResult* result) const;
  void AvoidContact(Workspace* workspace, Workload* workload, GeodesicResult* result) const;
  void Describe(GeodesicSummary* summary) const;

  const std::shared_ptr<const Metric> metric_;
  const GeodesicOptions options_;
  const GeodesicSchedule kind_;
  const Hierarchy hierarchy_;
  const std::vector<SharedLevel> levels_;
  const std::vector<int> without_cost_;  // vertices of the mesh itself
  mutable std::mutex mutex_;
  mutable std::vector<Workspace> idle_;  // guarded by mutex_
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_DETAIL_GEODESIC_LEVELS_H_
