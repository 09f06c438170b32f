#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/minimise/detail/chunks.h>
#include <shapespace/minimise/detail/line_search.h>
#include <shapespace/minimise/internal/minimise.h>

namespace shapespace::internal {
namespace {

// A pair of step and change of gradient enters the history if the slope along the step has
// increased by at least this share of its initial absolute value.
constexpr double kMinCurvature = 1e-3;

// If the estimated gain is less than this share of the tolerance, the start is a minimum, or a line
// search without decrease has converged to rounding.
constexpr double kNothingLeft = 1e-3;

// After a decrease below the tolerance, a prediction of less than this share of it ends the solve.
// With 1, elephants and cats lose up to 2 % of energy.
constexpr double kLittle = 0.5;

// Uninitialised memory, so that all threads take part in its first write.
template <typename Number>
using Buffer = std::unique_ptr<Number[]>;
template <typename Number = double>
Buffer<Number> MakeBuffer(size_t size) {
  return Buffer<Number>(new Number[size]);
}

// The usual algorithm traverses the history twice, backward and forward, and each scalar product
// depends on the previous one. Here the vectors' scalar products with each other are stored, so
// that all linear combinations of a traversal take one pass over memory, and all its scalar
// products another.
class ThreadedLbfgs {
 public:
  ThreadedLbfgs(const Objective& energy, const Precondition& precondition,
                const MinimiseOptions& options, std::vector<double>* unknowns)
      : energy_(energy),
        precondition_(precondition),
        options_(options),
        unknowns_(*unknowns),
        tolerance_(options.tolerance),
        size_(unknowns->size()),
        x_(MakeBuffer(size_)),
        work_(MakeBuffer(size_)),
        preconditioned_(MakeBuffer(size_)),
        change_(MakeBuffer(size_)),
        gradient_(MakeBuffer(size_)),
        trial_gradient_(MakeBuffer(size_)) {}

  MinimiseResult Run() {
    Copy(unknowns_.data(), x_.get());
    value_ = Evaluate(x_, gradient_.get());
    if (!std::isfinite(value_)) {
      throw SolverError("the energy of the path to start from is not finite");
    }
    result_.initial_energy = value_;
    unit_ = std::sqrt(value_);
    result_.termination = value_ == 0 ? Termination::kConverged : IterateUntilTrusted();
    result_.energy = value_;
    if (result_.termination == Termination::kStalled &&
        result_.remaining < kNothingLeft * options_.tolerance) {
      result_.termination = Termination::kConverged;
    }
    Copy(x_.get(), unknowns_.data());
    return result_;
  }

 private:
  // The vectors are in single precision, which causes no inconsistency: a step is taken along the
  // rounded `direction`, and the preconditioner works in single precision anyway.
  struct Pair {
    Buffer<float> direction;   // of the unknowns, not scaled by `length`
    Buffer<float> change;      // of the gradient, preconditioned
    double length = 0;         // the step is `length` times `direction`
    double curvature = 0;      // step . change of the gradient
    double step_gradient = 0;  // step . gradient at the current point
    // For this pair and each later one: step . change of the gradient, and the product of the
    // change of the gradient with the preconditioned one.
    std::vector<double> step_change, change_change;
  };

  void Copy(const double* from, double* to) {
    ForChunks(size_, 0, [&](size_t begin, size_t count, double*) {
      std::copy_n(from + begin, count, to + begin);
    });
  }

  double Evaluate(const Buffer<double>& unknowns, double* gradient) {
    ++result_.evaluations;
    return energy_(unknowns.get(), gradient);
  }

  // Half the product of the gradient and the preconditioned gradient.
  double SteepestDecrease() {
    precondition_(gradient_.get(), unit_, work_.get());
    return 0.5 * ForChunks(size_, 1, [&](size_t begin, size_t count, double* sums) {
             sums[0] += Dot(&gradient_[begin], &work_[begin], count);
           })[0];
  }

  // As long as the remaining decrease contradicts convergence, iterates on with smaller tolerances,
  // without the history.
  Termination IterateUntilTrusted() {
    for (;;) {
      const double before = value_;
      const Termination termination = Iterate();
      result_.remaining = SteepestDecrease() / value_;
      // In single precision rounding may make it negative, which is no convergence either.
      if (termination != Termination::kConverged || enough_gained_ ||
          std::abs(result_.remaining) <= options_.trusted_remaining * options_.tolerance) {
        return termination;
      }
      if (options_.enough > 0 || value_ == before) return Termination::kStalled;
      tolerance_ *= kMoreAccurate;
      history_.clear();
      fresh_change_ = false;
      scale_ = 1;
    }
  }

  Termination Iterate() {
    // One short step of the line search is no sign of convergence; two small decreases in a row end
    // the solve. It is enough if the second is small in the model, whose prediction alone is no
    // sign of convergence either: on some meshes ten iterations gain more than it says.
    int small = 0;
    for (;; ++result_.iterations) {
      if (options_.keep_going && !options_.keep_going(result_.iterations, value_)) {
        return Termination::kCancelled;
      }
      if (small >= 2) return Termination::kConverged;
      if (result_.iterations >= options_.max_iterations) return Termination::kMaxIterations;
      const double before = value_;
      double slope = FindDirection();
      const double predicted_decrease = -0.5 * slope;  // gain predicted by the model
      // If rounding makes the direction lead upwards, the predicted gain has no meaning.
      const double least = (small >= 1 ? kLittle : kNothingLeft) * tolerance_ * value_;
      if (predicted_decrease >= 0 && predicted_decrease <= least) return Termination::kConverged;
      enough_gained_ = predicted_decrease >= 0 &&
                       predicted_decrease <= options_.enough * (result_.initial_energy - value_);
      if (enough_gained_) return Termination::kConverged;
      if (!Search(slope)) {
        if (fresh_) return Termination::kStalled;
        history_.clear();
        slope = FindDirection();
        if (!Search(slope)) return Termination::kStalled;
      }
      if (refused_) continue;
      // A step that had to be short says nothing about what is left.
      small = !cut_ && before - value_ < tolerance_ * value_ ? small + 1 : 0;
    }
  }

  // Preconditions the gradient and thereby its last change, and computes the products of the latter
  // with all changes. Returns the products of the gradient with each preconditioned change. The
  // preconditioner's scale is adapted to the last step's curvature (Nocedal and Wright, equation
  // 7.20), unless that was cut to less than a whole one: what cuts it is mostly far stiffer than
  // all the rest, for which the next steps would be far too short.
  std::vector<double> PreconditionGradient() {
    precondition_(gradient_.get(), unit_, work_.get());
    const int pairs = static_cast<int>(history_.size());
    std::vector<double> products =
        ForChunks(size_, 2 * pairs, [&](size_t begin, size_t count, double* sums) {
          if (fresh_change_) {
            Combine(&work_[begin], -1, &preconditioned_[begin], &history_.back().change[begin],
                    count);
          }
          for (int i = 0; i < pairs; ++i) {
            const float* const change = &history_[i].change[begin];
            sums[i] += Dot(change, &gradient_[begin], count);
            if (fresh_change_) sums[pairs + i] += Dot(change, &change_[begin], count);
          }
        });
    if (fresh_change_) {
      for (int i = 0; i < pairs; ++i) history_[i].change_change.push_back(products[pairs + i]);
      const double product = products.back();
      const bool shortened = cut_ && history_.back().length < 1;
      if (product > 0 && !shortened) scale_ = history_.back().curvature / product;
    }
    fresh_change_ = false;
    preconditioned_.swap(work_);
    products.resize(pairs);
    return products;
  }

  // The coefficients of minus the direction as a linear combination of the (preconditioned) changes
  // and steps of the pairs, from the two traversals of the history, on scalar products alone.
  struct Weights {
    std::vector<double> changes, steps;
  };
  Weights TwoLoopRecursion(const std::vector<double>& products) const {
    const int pairs = static_cast<int>(history_.size());
    std::vector<double> back(pairs), forth(pairs);
    for (int i = pairs - 1; i >= 0; --i) {
      const Pair& pair = history_[i];
      double sum = pair.step_gradient;
      for (int j = i + 1; j < pairs; ++j) sum -= back[j] * pair.step_change[j - i];
      back[i] = sum / pair.curvature;
    }
    for (int i = 0; i < pairs; ++i) {
      double sum = products[i];
      for (int j = 0; j < pairs; ++j) {
        sum -= back[j] * history_[std::min(i, j)].change_change[std::abs(i - j)];
      }
      sum *= scale_;
      for (int j = 0; j < i; ++j) sum += forth[j] * history_[j].step_change[i - j];
      forth[i] = back[i] - sum / history_[i].curvature;
    }
    Weights weights;
    for (int i = 0; i < pairs; ++i) {
      weights.changes.push_back(-scale_ * back[i]);
      weights.steps.push_back(forth[i] * history_[i].length);
    }
    return weights;
  }

  // Appends a pair whose direction is minus the quasi-Newton approximation times the gradient, and
  // stores the end of a full step in `work_`. Returns the slope.
  double FindDirection() {
    const int pairs = static_cast<int>(history_.size());
    fresh_ = pairs == 0;
    const Weights weights = TwoLoopRecursion(PreconditionGradient());
    Pair next;
    const bool full = pairs == options_.rank;
    if (full) {  // the oldest pair's memory is overwritten chunk by chunk
      next.direction.swap(history_.front().direction);
    } else {
      next.direction = MakeBuffer<float>(size_);
    }
    const double slope = ForChunks(size_, 1, [&](size_t begin, size_t count, double* sums) {
      double* const z = &work_[begin];
      for (size_t k = 0; k < count; ++k) z[k] = scale_ * preconditioned_[begin + k];
      for (int i = 0; i < pairs; ++i) {
        Add(weights.changes[i], &history_[i].change[begin], z, count);
        const Buffer<float>& direction = i == 0 && full ? next.direction : history_[i].direction;
        Add(weights.steps[i], &direction[begin], z, count);
      }
      float* const d = &next.direction[begin];
      for (size_t k = 0; k < count; ++k) d[k] = static_cast<float>(-z[k]);
      sums[0] += Dot(d, &gradient_[begin], count);
      Combine(&x_[begin], 1, d, z, count);
    })[0];
    if (full) {
      next.change.swap(history_.front().change);
      history_.erase(history_.begin());
    } else {
      next.change = MakeBuffer<float>(size_);
    }
    history_.push_back(std::move(next));
    return slope;
  }

  // Searches along the last pair's direction and completes the pair, or drops it. Returns false if
  // no lower point was found.
  bool Search(double slope) {
    Pair& last = history_.back();
    const Buffer<float>& direction = last.direction;
    bool whole = true;  // `work_` contains the end of a full step
    const LinePoint start = {0, value_, slope};
    double longest = std::numeric_limits<double>::infinity();
    if (options_.longest_step) {
      longest = shortening_ * options_.longest_step(x_.get(), direction.get());
    }
    const auto evaluate = [&](double step) {
      if (!whole || step != 1) {
        ForChunks(size_, 0, [&](size_t begin, size_t count, double*) {
          Combine(&x_[begin], step, &direction[begin], &work_[begin], count);
        });
        whole = step == 1;
      }
      const double value = Evaluate(work_, trial_gradient_.get());
      const double trial_slope = ForChunks(size_, 1, [&](size_t begin, size_t count, double* sums) {
        sums[0] += Dot(&direction[begin], &trial_gradient_[begin], count);
      })[0];
      return LinePoint{step, value, trial_slope};
    };
    const LinePoint end = slope < 0 ? SearchLine(start, evaluate, longest) : start;
    if (end.step == 0) {
      history_.pop_back();
      return false;
    }
    refused_ = options_.allows && !options_.allows(work_.get());
    if (refused_) {
      StayHere();
      return true;
    }
    cut_ = end.step == longest;
    shortening_ = 1;
    x_.swap(work_);
    value_ = end.value;
    const int pairs = static_cast<int>(history_.size());
    last.length = end.step;
    last.curvature = end.step * (end.slope - slope);
    // The change overwrites the old gradient.
    const std::vector<double> products =
        ForChunks(size_, pairs, [&](size_t begin, size_t count, double* sums) {
          Combine(&trial_gradient_[begin], -1, &gradient_[begin], &gradient_[begin], count);
          for (int i = 0; i + 1 < pairs; ++i) {
            sums[i] += Dot(&history_[i].direction[begin], &trial_gradient_[begin], count);
          }
        });
    change_.swap(gradient_);
    gradient_.swap(trial_gradient_);
    for (int i = 0; i + 1 < pairs; ++i) {
      Pair& pair = history_[i];
      const double product = pair.length * products[i];
      pair.step_change.push_back(product - pair.step_gradient);
      pair.step_gradient = product;
    }
    last.step_gradient = end.step * end.slope;
    last.step_change = {last.curvature};
    fresh_change_ = end.slope - slope >= -kMinCurvature * slope;
    if (!fresh_change_) {
      history_.pop_back();
      for (Pair& pair : history_) pair.step_change.pop_back();
    }
    return true;
  }

  // After a point was refused: the objective may be another one.
  void StayHere() {
    history_.pop_back();
    shortening_ /= 2;
    value_ = Evaluate(x_, gradient_.get());
    const int pairs = static_cast<int>(history_.size());
    const std::vector<double> products =
        ForChunks(size_, pairs, [&](size_t begin, size_t count, double* sums) {
          for (int i = 0; i < pairs; ++i) {
            sums[i] += Dot(&history_[i].direction[begin], &gradient_[begin], count);
          }
        });
    for (int i = 0; i < pairs; ++i) history_[i].step_gradient = history_[i].length * products[i];
  }

  const Objective& energy_;
  const Precondition& precondition_;
  const MinimiseOptions& options_;
  std::vector<double>& unknowns_;
  double tolerance_;  // of decreases
  const size_t size_;
  Buffer<double> x_, work_, preconditioned_, change_, gradient_, trial_gradient_;
  double value_ = 0, unit_ = 1, scale_ = 1;
  bool fresh_ = true;           // no history influences the direction
  bool fresh_change_ = false;   // the last pair's change has not been preconditioned yet
  bool refused_ = false;        // the last search's point was not allowed
  bool enough_gained_ = false;  // MinimiseOptions::enough has ended the solve
  bool cut_ = false;            // the last step was as long as allowed
  double shortening_ = 1;       // of the longest step, after points were refused
  std::vector<Pair> history_;   // oldest first
  MinimiseResult result_;
};

}  // namespace

double RemainingDecrease(PathEnergy* energy, Preconditioner* preconditioner,
                         const std::vector<double>& unknowns) {
  std::vector<double> gradient(unknowns.size()), step(unknowns.size());
  const double value = energy->Evaluate(unknowns.data(), gradient.data());
  if (value == 0) return 0;
  preconditioner->Apply(gradient.data(), std::sqrt(value), step.data());
  return 0.5 * Dot(gradient.data(), step.data(), step.size()) / value;
}

MinimiseResult MinimiseThreadedLbfgs(const Objective& energy, const Precondition& precondition,
                                     const MinimiseOptions& options,
                                     std::vector<double>* unknowns) {
  return ThreadedLbfgs(energy, precondition, options, unknowns).Run();
}

MinimiseResult MinimiseThreadedLbfgs(PathEnergy* energy, Preconditioner* preconditioner,
                                     const MinimiseOptions& options,
                                     std::vector<double>* unknowns) {
  return MinimiseThreadedLbfgs(ObjectiveOf(energy), PreconditionOf(preconditioner), options,
                               unknowns);
}

}  // namespace shapespace::internal
