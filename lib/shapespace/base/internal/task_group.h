#ifndef SHAPESPACE_BASE_INTERNAL_TASK_GROUP_H_
#define SHAPESPACE_BASE_INTERNAL_TASK_GROUP_H_

#include <exception>
#include <functional>
#include <mutex>
#include <string>

#include <shapespace/base/progress.h>

namespace shapespace::internal {

/// A task, which reports to `progress` and ends when that asks it to stop.
using Task = std::function<void(Progress* progress)>;

/// Tasks of one call that run at the same time. They report to the call's progress from one thread
/// at a time. When that asks to stop, or a task fails, all of them are stopped.
class TaskGroup {
 public:
  /// For a stage of `total` tasks; `progress` may be null.
  TaskGroup(Progress* progress, std::string stage, int total);

  /// Runs all tasks, at most `at_once` of them at a time. \throw what the first that failed has
  /// thrown, when all have ended.
  void RunAll(int at_once, const std::function<void(int task, Progress* progress)>& body);

  /// Runs task number `i` in the calling thread; all with smaller numbers have begun already, here
  /// or in other processes. \throw as the task, or Cancelled without calling it if tasks are to
  /// stop.
  void Run(int i, const Task& task);

  /// Calls `run_all`, which calls `Run` for tasks of the group. \throw what the first task that
  /// failed has thrown, or else as `run_all`.
  void Guard(const std::function<void()>& run_all);

 private:
  class One;
  int NumEnded();
  bool Report();

  Progress* const progress_;
  const std::string stage_;
  const int total_;
  std::mutex mutex_;  // guards what follows, and calls of progress_
  int begun_ = 0, running_ = 0, ended_ = 0;
  bool alone_ = false;  // all tasks run in this process
  bool stopped_ = false;
  std::exception_ptr first_error_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_TASK_GROUP_H_
