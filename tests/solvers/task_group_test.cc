#include <shapespace/base/internal/task_group.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>

#include "support/listener.h"
#include "support/message_of.h"
#include "support/threads.h"

namespace shapespace::internal {
namespace {

using testing::Listener;

// A task that reports so often and ends when it is asked to.
void Work(int reports, Progress* progress) {
  for (int k = 0; k < reports; ++k) {
    ReportProgress(progress, "one task", k, reports);
    testing::Spin(2);
  }
}

TEST(TaskGroup, ReportsFromOneThreadAtATimeHowManyTasksHaveEnded) {
  for (const int reports : testing::OnThreads([] {
         Listener listener;
         std::mutex mutex;
         int last = 0;
         listener.on_report = [&](const std::string& stage, int done) {
           ASSERT_TRUE(mutex.try_lock()) << "two reports at a time";
           EXPECT_EQ(stage, "all tasks");
           EXPECT_GE(done, last);
           EXPECT_LT(done, 12);
           last = done;
           testing::Spin(2);
           mutex.unlock();
         };
         TaskGroup(&listener, "all tasks", 12).RunAll(5, [](int, Progress* progress) {
           Work(10, progress);
         });
         EXPECT_GE(last, 12 - 5);
         EXPECT_TRUE(std::is_sorted(listener.shares.begin(), listener.shares.end()));
         EXPECT_EQ(listener.shares.size(), 13u);
         EXPECT_EQ(listener.shares.front(), 0);
         EXPECT_EQ(listener.shares.back(), 1);
         return listener.reports;
       })) {
    EXPECT_EQ(reports, 12 * 11);  // and one where each begins
  }
}

// `Listener` fails the test if there is a report after that.
TEST(TaskGroup, StopsAllTasksWhenAskedTo) {
  for (const int last : {1, 2, 30, 100}) {
    testing::OnThreads([&] {
      Listener listener(last);
      EXPECT_THROW(TaskGroup(&listener, "", 12)
                       .RunAll(5, [](int, Progress* progress) { Work(10, progress); }),
                   Cancelled);
      return 0;
    });
  }
}

TEST(TaskGroup, ThrowsWhatFailedAndNotWhatItStopped) {
  for (const bool without_progress : {false, true}) {
    testing::OnThreads([&] {
      Listener listener;
      const std::string message = testing::MessageOf<std::runtime_error>([&] {
        TaskGroup(without_progress ? nullptr : &listener, "", 12)
            .RunAll(5, [](int i, Progress* progress) {
              if (i == 3) throw std::runtime_error("3 failed");
              Work(200, progress);
            });
      });
      EXPECT_EQ(message, "3 failed");
      EXPECT_LT(listener.reports, 12 * 200);
      return 0;
    });
  }
}

// Here another task certainly runs when the first one fails, and ends because of that.
TEST(TaskGroup, WhatWasStoppedDoesNotTakeThePlaceOfWhatFailed) {
  testing::OnThreads([] {
    std::atomic<bool> other_runs = NumThreads() == 1;
    EXPECT_EQ(testing::MessageOf<std::runtime_error>([&] {
                TaskGroup(nullptr, "", 12).RunAll(5, [&](int i, Progress* progress) {
                  if (i == 0) {
                    while (!other_runs) testing::Spin(10);
                    throw std::runtime_error("0 failed");
                  }
                  other_runs = true;
                  for (;; testing::Spin(20)) ReportProgress(progress, "one task", 0, 0);
                });
              }),
              "0 failed");
    return 0;
  });
}

TEST(TaskGroup, ThrowsWhatTheProgressThrows) {
  testing::OnThreads([] {
    Listener listener;
    listener.on_report = [&](const std::string&, int) {
      if (listener.reports == 25) throw std::logic_error("no more");
      EXPECT_LT(listener.reports, 25);
    };
    EXPECT_EQ(testing::MessageOf<std::logic_error>([&] {
                TaskGroup(&listener, "", 12).RunAll(5, [](int, Progress* progress) {
                  Work(10, progress);
                });
              }),
              "no more");
    return 0;
  });
}

}  // namespace
}  // namespace shapespace::internal
