#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_TEMPLATE_FIT_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_TEMPLATE_FIT_H_

#include <memory>
#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/correspondence/correspondence.h>
#include <shapespace/correspondence/detail/closest.h>
#include <shapespace/correspondence/detail/shell_fit.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// The markers of a fit, in ascending order of the template's vertices.
struct FitMarkers {
  std::vector<int> vertices;  ///< of the template
  Shape positions;            ///< where they belong, in the target's frame
  /// Whether each is met exactly. The others lead to the pose, in which they are met; from then on
  /// they are springs, and in the last rounds they are absent.
  std::vector<bool> held;
};

/// How far a fit goes.
enum class Effort {
  kRough,      ///< two rounds on the coarsest level, which tell what the fit is going to cost
  kKeepFolds,  ///< to the end, without unfolding, which takes most time with wrong markers
  kUnfold,
};

/// Fits the template onto the target level by level.
class TemplateFit {
 public:
  /// `options`, `target`, `progress` (may be null) and `summary` are kept.
  TemplateFit(const CorrespondenceOptions& options, const Target& target, FitMarkers markers,
              Effort effort, Progress* progress, CorrespondenceSummary* summary);

  /// `rest`: the template at rest, in the target's frame. \return the fitted template. Stages,
  /// seconds and how it ended are said in the summary.
  /// \throw Cancelled if there is no fit yet that is worth returning.
  Shape operator()(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest);

 private:
  // Indices in the level of all markers' vertices, or of those that are held.
  std::vector<int> MarkersOn(const Level& level) const;
  std::vector<int> HeldOn(const Level& level) const;
  bool Stops();
  void FitLevel(const Level& level, const Shape& rest, Shape* shape);
  void FindPose(const Level& level, const Shape& rest, Shape* shape);
  void FindTurns(const Level& level, const Shape& rest, Shape* shape);
  void Finish(const Level& level, const Shape& rest, Shape* shape);
  ShellFit MakeFit(const Level& level, const Shape& rest, double bending) const;
  void AddSprings(const Level& level, std::vector<PointToPlaneTerm>* terms) const;
  bool Rounds(const Level& level, ShellFit* fit, double weight, int rounds, Shape* shape);

  const CorrespondenceOptions& options_;
  const Target& target_;
  const FitMarkers markers_;
  const Effort effort_;
  Progress* const progress_;
  CorrespondenceSummary* const summary_;
  int level_ = 0, num_levels_ = 0;
  bool is_last_ = false;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_TEMPLATE_FIT_H_
