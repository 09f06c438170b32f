#ifndef SHAPESPACE_GEODESIC_DETAIL_GEODESIC_PIECE_H_
#define SHAPESPACE_GEODESIC_DETAIL_GEODESIC_PIECE_H_

#include <functional>
#include <optional>
#include <vector>

#include <shapespace/geodesic/detail/schedule.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/geodesic/internal/resolution.h>
#include <shapespace/hierarchy/hierarchy.h>

namespace shapespace::internal {

/// Where the first solve of a piece begins; none is the shape half-way of a `TurningMotion`.
using PieceStart = std::optional<GeodesicStart>;

/// Adds all steps that the `GeodesicPiece` between pose `index` and the next will take to
/// `workload`.
void Plan(int index, const std::vector<ScheduleStep>& schedule,
          const std::vector<Resolution>& resolutions, GeodesicStart start, Workload* workload);

/// The solve between two neighbouring poses, coarse to fine in space and time.
class GeodesicPiece {
 public:
  /// For the piece between pose `index` and the next. `resolutions` has one entry for each level of
  /// `hierarchy`; `workload` contains the piece's steps (`Plan`).
  /// `show`, which may be null, is called with the shapes on the finest level as they are so far.
  GeodesicPiece(int index, const Hierarchy& hierarchy, std::vector<Resolution>* resolutions,
                const GeodesicOptions& options, Workload* workload, GeodesicSummary* summary,
                std::function<void(std::vector<Shape>)> show);

  /// Takes all steps. The first ones, with one inner shape on few vertices, select the valley
  /// (local minimum) of the path: they are solved from one start after the other, until a result is
  /// near to the lower bound, and the best is continued. After `workload` was asked to stop, shapes
  /// are only lifted and refined. If a segment of the result jumps, and `more_shapes_allowed`
  /// (there is memory for twice as many), the jump is removed.
  void Run(const std::vector<ScheduleStep>& schedule, bool more_shapes_allowed);
  /// The path found on the finest level.
  std::vector<Shape> Result() && { return std::move(known_.back().shapes); }

 private:
  // The last result on a level: the ends and the inner shapes.
  struct Known {
    std::vector<Shape> shapes;
    // The shapes of the next coarser level from which they were lifted, at the same times.
    std::vector<Shape> base;
  };

  // The results on all levels after some steps of the schedule, from one start.
  struct Attempt {
    PieceStart start = GeodesicStart::kBlend;
    std::vector<Known> known = {};
    double energy = 0;              // scaled, of the last step
    std::vector<size_t> rows = {};  // in the summary's table
  };

  // Shows what the steps from `begin` on would give if they only lifted and refined.
  void Show(const std::vector<ScheduleStep>& schedule, size_t begin);
  Attempt TakeSteps(const std::vector<ScheduleStep>& schedule, size_t begin, size_t end,
                    Attempt attempt);
  // If a segment is much faster than the mean, a part rests and then turns over within it. There
  // the energy hardly depends on the shapes, because chords of half a circle are nearly equal, so
  // that descent does not find the even motion. With more shapes, distributed by arc length, the
  // turn takes several segments, and descent finds it. Solves with about twice as many shapes, then
  // with the number of `last`, the schedule's last step, again; keeps the result if it has less
  // energy.
  void RemoveJump(const ScheduleStep& last);
  // Solves a level with a number of shapes, from the guess for it.
  void TakeStep(const ScheduleStep& step, PieceStart start, bool last);

  // Where a solve begins, and its name in the summary.
  struct Guess {
    std::vector<Shape> shapes;
    const char* name = nullptr;
  };
  // From two shapes, the ends, on: lifted, or as `start` says. From more on: lifted; if that has
  // much more energy than the path so far, refined if it has less; if both have, and few vertices,
  // with shapes inserted one by one.
  Guess GuessFor(const ScheduleStep& step, PieceStart start);
  double Energy(int level, const std::vector<Shape>& path);
  // Whether the coarser level has as many shapes as the step, and the level's own shapes were
  // lifted from some.
  bool CanLift(const ScheduleStep& step) const;
  // The coarser level's shapes with detail from this level's earlier shapes. The detail at a time
  // is taken from the earlier shapes around it, each relative to the coarse shape of its own time,
  // which is correct also if parts turn far between these times.
  Guess Lift(const ScheduleStep& step);
  // The level's shapes, on cubics in time by arc length.
  Guess Refine(const ScheduleStep& step) const;
  // The level's shapes with one more between each two, the best solution between these two from
  // three initial guesses: either neighbour, and the corresponding one of `guess`.
  Guess InsertShapes(int level, const std::vector<Shape>& guess);
  Guess OneInnerShape(PieceStart start, int level);

  const int index_;
  const Hierarchy& hierarchy_;
  std::vector<Resolution>& resolutions_;
  const GeodesicOptions& options_;
  Workload& workload_;
  GeodesicSummary& summary_;
  const std::function<void(std::vector<Shape>)> show_;
  std::vector<Known> known_;  // per level
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_DETAIL_GEODESIC_PIECE_H_
