#ifndef SHAPESPACE_MINIMISE_INTERNAL_KEEP_GOING_H_
#define SHAPESPACE_MINIMISE_INTERNAL_KEEP_GOING_H_

#include <functional>

#include <ceres/iteration_callback.h>

namespace shapespace::internal {

/// Asks after every iteration of a Ceres solver whether to continue; if not, the solver ends with
/// USER_SUCCESS, so that Ceres returns the best iterate.
class KeepGoing final : public ceres::IterationCallback {
 public:
  explicit KeepGoing(const std::function<bool(int, double)>& ask) : ask_(ask) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    stopped_ = ask_ && !ask_(summary.iteration, summary.cost);
    return stopped_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }
  bool Stopped() const { return stopped_; }

 private:
  const std::function<bool(int, double)>& ask_;
  bool stopped_ = false;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MINIMISE_INTERNAL_KEEP_GOING_H_
