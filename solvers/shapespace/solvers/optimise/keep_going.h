#ifndef SHAPESPACE_SOLVERS_OPTIMISE_KEEP_GOING_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_KEEP_GOING_H_

#include <functional>

#include <ceres/iteration_callback.h>

namespace shapespace::internal {

/// Asks after every iteration of a Ceres solver whether to go on; a no ends it as USER_FAILURE.
class KeepGoing final : public ceres::IterationCallback {
 public:
  explicit KeepGoing(const std::function<bool(int)>& ask) : ask_(ask) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    return !ask_ || ask_(summary.iteration) ? ceres::SOLVER_CONTINUE : ceres::SOLVER_ABORT;
  }

 private:
  const std::function<bool(int)>& ask_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_KEEP_GOING_H_
