#ifndef SHAPESPACE_SOLVERS_OPTIMISE_PIECE_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_PIECE_H_

#include <vector>

#include <shapespace/hierarchy/hierarchy.h>
#include <shapespace/solvers/geodesic.h>
#include <shapespace/solvers/optimise/resolution.h>
#include <shapespace/solvers/optimise/schedule.h>

namespace shapespace::internal {

/// Tells `workload` of all steps that a `Piece` will take.
void Plan(const std::vector<ScheduleStep>& schedule, const std::vector<Resolution>& resolutions,
          GeodesicStart start, Workload* workload);

/// The solve between two neighbouring poses, coarse to fine in space and time.
class Piece {
 public:
  /// Between pose `index` and the next. `resolutions` has one entry for each level of `hierarchy`;
  /// `workload` knows of the piece (`Plan`).
  Piece(int index, const Hierarchy& hierarchy, std::vector<Resolution>* resolutions,
        const GeodesicOptions& options, Workload* workload, GeodesicSummary* summary);

  /// Takes all steps. The first ones, with one inner shape on few vertices, decide which valley the
  /// whole body lies in: they are taken from every start, and the best goes on. Once `workload` was
  /// asked to stop nothing is solved any more: shapes are lifted and refined only.
  void Run(const std::vector<ScheduleStep>& schedule);
  /// The path found on the finest level.
  std::vector<Shape> Result() && { return std::move(known_.back().shapes); }

 private:
  // What was found last on a level: the ends and the inner shapes.
  struct Known {
    std::vector<Shape> shapes;
    // The shapes of the next coarser level on which they sit, found for the same times.
    std::vector<Shape> base;
  };

  // All levels after some steps of the schedule, from one start.
  struct Attempt {
    GeodesicStart start = GeodesicStart::kBlend;
    std::vector<Known> known = {};
    double energy = 0;              // scaled, of the last step
    std::vector<size_t> rows = {};  // of the summary's table
  };

  Attempt TakeSteps(const std::vector<ScheduleStep>& schedule, size_t begin, size_t end,
                    Attempt attempt);
  void TakeStep(const ScheduleStep& step, GeodesicStart start, bool last);
  std::vector<Shape> OneInnerShape(GeodesicStart start, int level);
  // The coarser level's shapes with the detail that this level's shapes had, at the times around
  // each, on the coarser level's then: right also where parts turn far between those times.
  std::vector<Shape> Lift(const ScheduleStep& step) const;

  const int index_;
  const Hierarchy& hierarchy_;
  std::vector<Resolution>& resolutions_;
  const GeodesicOptions& options_;
  Workload& workload_;
  GeodesicSummary& summary_;
  std::vector<Known> known_;  // by level
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_PIECE_H_
