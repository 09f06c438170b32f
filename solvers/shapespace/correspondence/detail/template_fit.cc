#include <shapespace/correspondence/detail/template_fit.h>

#include <algorithm>
#include <utility>

#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/correspondence/detail/gradient_fit.h>
#include <shapespace/correspondence/detail/limb_turns.h>
#include <shapespace/correspondence/detail/unfold.h>
#include <shapespace/hierarchy/hierarchy.h>

namespace shapespace::internal {
namespace {

// Weights of the closest-point terms, ascending; their meaning is explained where they are used.
// With these values all pairs reach the figures of docs/measurements.md; half or twice as many
// rounds change the figures by less than a tenth.
constexpr double kCoarseWeights[] = {1, 3, 10, 30, 100};
constexpr int kCoarseRounds = 6, kRoughRounds = 2;
constexpr double kFineWeight = 100, kLastWeight = 1000;
constexpr int kFineRounds = 3;
// Factor of the bending weight during the search for the pose.
constexpr double kCoarseBending = 3;
// Weight of all springs together. With a tenth of it a gorilla's arm was not found from a woman's;
// ten times as much is slightly worse.
constexpr double kSprings = 10;

int IndexOn(const Level& level, int v) {
  const auto found = std::lower_bound(level.vertices.begin(), level.vertices.end(), v);
  return static_cast<int>(found - level.vertices.begin());
}

}  // namespace

TemplateFit::TemplateFit(const CorrespondenceOptions& options, const Target& target,
                         FitMarkers markers, Effort effort, Progress* progress,
                         CorrespondenceSummary* summary)
    : options_(options),
      target_(target),
      markers_(std::move(markers)),
      effort_(effort),
      progress_(progress),
      summary_(summary) {}

Shape TemplateFit::operator()(const std::shared_ptr<const Connectivity>& connectivity,
                              const Shape& rest) {
  const Stopwatch stopwatch;
  HierarchyOptions hierarchy_options;
  hierarchy_options.coarsest = options_.coarsest;
  hierarchy_options.pinned = markers_.vertices;
  const Hierarchy hierarchy(connectivity, {rest}, hierarchy_options);
  summary_->hierarchy_seconds = stopwatch.Seconds();
  num_levels_ = hierarchy.NumLevels();
  Shape shape = hierarchy.Restrict(rest, 0);
  for (level_ = 0; level_ < num_levels_; ++level_) {
    const Shape level_rest = hierarchy.Restrict(rest, level_);
    const Level level = {hierarchy.LevelConnectivity(level_), hierarchy.Vertices(level_),
                         BorderOf(*hierarchy.LevelConnectivity(level_))};
    FitLevel(level, level_rest, &shape);
    if (level_ + 1 < num_levels_) {
      const Shape finer = hierarchy.Restrict(rest, level_ + 1);
      shape = hierarchy.Lift(shape, level_, finer, finer, 0);
    }
  }
  summary_->fit_seconds = stopwatch.Seconds() - summary_->hierarchy_seconds;
  return shape;
}

void TemplateFit::FitLevel(const Level& level, const Shape& rest, Shape* shape) {
  if (level_ == 0) FindPose(level, rest, shape);
  if (effort_ == Effort::kRough) return;
  // On the first level hands are too coarse to tell their palms from their backs.
  if (level_ == 1) FindTurns(level, rest, shape);
  if (level_ + 1 == num_levels_) {
    Finish(level, rest, shape);
  } else if (level_ > 0) {
    ShellFit fit = MakeFit(level, rest, options_.bending);
    Rounds(level, &fit, kFineWeight, kFineRounds, shape);
    // The last weight is reached here, where a round takes a quarter of the time of one on the last
    // level.
    if (level_ + 2 == num_levels_) {
      Rounds(level, &fit, kLastWeight, options_.max_iterations, shape);
    }
  }
}

std::vector<int> TemplateFit::MarkersOn(const Level& level) const {
  std::vector<int> indices;
  for (const int v : markers_.vertices) indices.push_back(IndexOn(level, v));
  return indices;
}

std::vector<int> TemplateFit::HeldOn(const Level& level) const {
  std::vector<int> indices;
  for (size_t i = 0; i < markers_.vertices.size(); ++i) {
    if (markers_.held[i]) indices.push_back(IndexOn(level, markers_.vertices[i]));
  }
  return indices;
}

// If asked to stop, the last level ends early; before that there is no result worth returning.
bool TemplateFit::Stops() {
  if (summary_->cancelled) return true;
  if (progress_ == nullptr || progress_->Report("fitting, level", level_ + 1, num_levels_)) {
    return false;
  }
  if (level_ + 1 < num_levels_ || !is_last_) throw Cancelled();
  summary_->cancelled = true;
  return true;
}

// Starts from the markers alone, approaches the pose with the gradient fit, then continues under
// strain and bending.
void TemplateFit::FindPose(const Level& level, const Shape& rest, Shape* shape) {
  const Stopwatch stopwatch;
  Stops();
  *shape = GradientFit(*level.connectivity, rest, MarkersOn(level), kIdentity)(markers_.positions);
  level.connectivity->CopyToTwins(shape);
  CorrespondenceSummary::Stage stage;
  stage.vertices = static_cast<int>(shape->cols());
  stage.name = "gradients";
  stage.weight = 0;
  stage.rounds = 1;
  stage.seconds = stopwatch.Seconds();
  summary_->stages.push_back(stage);
  ShellFit shell = MakeFit(level, rest, kCoarseBending * options_.bending);
  if (effort_ == Effort::kRough) {
    Rounds(level, &shell, kCoarseWeights[0], kRoughRounds, shape);
    return;
  }
  for (const double weight : kCoarseWeights) {
    Rounds(level, &shell, weight, kCoarseRounds, shape);
  }
}

void TemplateFit::FindTurns(const Level& level, const Shape& rest, Shape* shape) {
  const Stopwatch stopwatch;
  CorrespondenceSummary::Stage stage;
  stage.vertices = static_cast<int>(shape->cols());
  stage.name = "turns";
  stage.weight = kLastWeight;
  stage.rounds = TurnLimbs(level, rest, HeldOn(level), target_, options_, progress_, shape);
  stage.seconds = stopwatch.Seconds();
  summary_->stages.push_back(stage);
}

void TemplateFit::Finish(const Level& level, const Shape& rest, Shape* shape) {
  ShellFit fit = MakeFit(level, rest, options_.bending);
  is_last_ = true;
  // Of three levels and more, the one before has come to rest under the last weight.
  if (num_levels_ < 3) Rounds(level, &fit, kFineWeight, kFineRounds, shape);
  summary_->converged =
      Rounds(level, &fit, kLastWeight, options_.max_iterations, shape) && !summary_->cancelled;
  const Stopwatch stopwatch;
  if (effort_ == Effort::kUnfold) Unfold(level, rest, target_, HeldOn(level), shape);
  level.connectivity->CopyToTwins(shape);
  summary_->unfold_seconds = stopwatch.Seconds();
}

ShellFit TemplateFit::MakeFit(const Level& level, const Shape& rest, double bending) const {
  return {level.connectivity, rest, HeldOn(level), bending, options_.proportions};
}

void TemplateFit::AddSprings(const Level& level, std::vector<PointToPlaneTerm>* terms) const {
  const double weight = kSprings / static_cast<double>(markers_.vertices.size());
  for (size_t i = 0; i < markers_.vertices.size(); ++i) {
    if (markers_.held[i]) continue;
    const Eigen::Vector3i vertices =
        Eigen::Vector3i::Constant(IndexOn(level, markers_.vertices[i]));
    terms->push_back({vertices, Eigen::Vector3d::UnitX(),
                      markers_.positions.col(static_cast<int>(i)), Eigen::Vector3d::Zero(), weight,
                      1});
  }
}

// \return whether the vertices stopped moving.
bool TemplateFit::Rounds(const Level& level, ShellFit* fit, double weight, int rounds,
                         Shape* shape) {
  const Stopwatch stopwatch;
  CorrespondenceSummary::Stage stage;
  stage.vertices = static_cast<int>(shape->cols());
  stage.name = "shell";
  stage.weight = weight;
  // It is enough to use about as many of the target's vertices as the level has.
  const TargetSamples samples = SampleTarget(target_, 2 * stage.vertices);
  bool at_rest = false;
  while (!at_rest && stage.rounds < rounds && !Stops()) {
    std::vector<PointToPlaneTerm> terms =
        FindTerms(level, *shape, fit->VertexAreas(), target_, samples, weight, &stage.distance);
    if (weight < kLastWeight) AddSprings(level, &terms);
    stage.motion = fit->Step(terms, shape);
    ++stage.rounds;
    at_rest = stage.motion < options_.tolerance;
  }
  stage.seconds = stopwatch.Seconds();
  summary_->stages.push_back(stage);
  return at_rest;
}

}  // namespace shapespace::internal
