#ifndef SHAPESPACE_BASE_INTERNAL_SUB_PROGRESS_H_
#define SHAPESPACE_BASE_INTERNAL_SUB_PROGRESS_H_

#include <string>
#include <utility>

#include <shapespace/base/progress.h>

namespace shapespace::internal {

/// Reports the progress of a nested call as a part of the work of the outer call, whose `all` may
/// be null.
class SubProgress final : public Progress {
 public:
  /// From share `begin` to share `end` of all work; stages are those of the nested call.
  SubProgress(Progress* all, double begin, double end) : all_(all), begin_(begin), end_(end) {}

  /// Unit `done` of the `total` units of a stage, which alone is reported.
  SubProgress(Progress* all, std::string stage, int done, int total)
      : all_(all), stage_(std::move(stage)), done_(done), total_(total) {}

  bool Report(const std::string& stage, int done, int total) override {
    if (all_ == nullptr) return true;
    return stage_.empty() ? all_->Report(stage, done, total) : all_->Report(stage_, done_, total_);
  }
  void ReportShare(double share) override {
    if (all_ != nullptr && stage_.empty()) all_->ReportShare(begin_ + share * (end_ - begin_));
  }

 private:
  Progress* const all_;
  const double begin_ = 0, end_ = 0;
  const std::string stage_;
  const int done_ = 0, total_ = 0;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_SUB_PROGRESS_H_
