#include <shapespace/base/internal/task_group.h>

#include <algorithm>
#include <utility>

#include <shapespace/base/parallel.h>

namespace shapespace::internal {

// The progress of one task as a part of that of all.
class TaskGroup::One : public Progress {
 public:
  explicit One(TaskGroup* group) : group_(*group) {}
  bool Report(const std::string& /*stage*/, int /*done*/, int /*total*/) override {
    return group_.Report();
  }

 private:
  TaskGroup& group_;
};

TaskGroup::TaskGroup(Progress* progress, std::string stage, int total)
    : progress_(progress), stage_(std::move(stage)), total_(total) {
  if (progress_ != nullptr) progress_->ReportShare(0);
}

void TaskGroup::RunAll(int at_once, const std::function<void(int, Progress*)>& body) {
  alone_ = true;
  Guard([&] {
    ParallelTasks(total_, at_once,
                  [&](int i) { Run(i, [&](Progress* progress) { body(i, progress); }); });
  });
}

void TaskGroup::Run(int i, const Task& task) {
  One one(this);
  try {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      // A smaller number may be that of a task of another process, which has begun there.
      begun_ = alone_ ? begun_ + 1 : std::max(begun_, i + 1);
      ++running_;
    }
    ReportProgress(&one, {}, 0, 0);
    task(&one);
    const std::lock_guard<std::mutex> lock(mutex_);
    --running_;
    if (progress_ != nullptr && !stopped_) {
      progress_->ReportShare(static_cast<double>(NumEnded()) / total_);
    }
  } catch (...) {
    // The first to come here is the one that failed; others end because of it.
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!first_error_) first_error_ = std::current_exception();
    stopped_ = true;
    throw;
  }
}

void TaskGroup::Guard(const std::function<void()>& run_all) {
  try {
    run_all();
  } catch (...) {
    if (first_error_) std::rethrow_exception(first_error_);
    throw;
  }
}

int TaskGroup::NumEnded() {
  // Less for a moment when two tasks have changed places since they were handed out.
  ended_ = std::max(ended_, begun_ - running_);
  return ended_;
}

bool TaskGroup::Report() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stopped_) return false;
  try {
    stopped_ = progress_ != nullptr && !progress_->Report(stage_, NumEnded(), total_);
  } catch (...) {
    first_error_ = std::current_exception();
    stopped_ = true;
    throw;
  }
  return !stopped_;
}

}  // namespace shapespace::internal
