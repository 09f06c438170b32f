#ifndef SHAPESPACE_TESTS_SUPPORT_LISTENER_H_
#define SHAPESPACE_TESTS_SUPPORT_LISTENER_H_

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/progress.h>

namespace shapespace::testing {

/// Records the reports of a call, and stops it at report number `last`, counted from 1. A stopped
/// call must make no further reports.
class Listener final : public Progress {
 public:
  explicit Listener(int last = std::numeric_limits<int>::max()) : last_(last) {}

  bool Report(const std::string& stage, int done, int) override {
    EXPECT_LT(reports, last_) << "reports on after it was stopped";
    ++reports;
    if (on_report) on_report(stage, done);
    return reports < last_;
  }
  void ReportShare(double share) override { shares.push_back(share); }

  int reports = 0;
  std::vector<double> shares;
  std::function<void(const std::string& stage, int done)> on_report;

 private:
  const int last_;
};

/// Numbers of reports at which to stop a call (`Listener`): at the first of a stage whose name
/// contains `stage`, half way from there to the end, and shortly before the end.
inline std::vector<int> StopsSince(const std::string& stage,
                                   const std::function<void(Progress*)>& call) {
  int first = 0;
  Listener all;
  all.on_report = [&](const std::string& now, int) {
    if (first == 0 && now.find(stage) != std::string::npos) first = all.reports;
  };
  call(&all);
  EXPECT_GT(first, 0) << stage;
  return {first, (first + all.reports) / 2, all.reports - 1};
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_LISTENER_H_
