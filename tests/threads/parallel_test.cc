#include <shapespace/base/parallel.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "support/message_of.h"
#include "support/threads.h"

namespace shapespace {
namespace {

// How many bodies run at the same time, if there are as many as threads and each waits for all.
int AtTheSameTime(int threads) {
  std::atomic<int> running{0};
  std::atomic<bool> gave_up{false};
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  ParallelFor(threads, [&](int) {
    ++running;
    while (running < threads && !gave_up) {
      if (std::chrono::steady_clock::now() > end) gave_up = true;
      std::this_thread::yield();
    }
    if (gave_up) --running;
  });
  return gave_up ? 0 : running.load();
}

TEST(SetThreads, GivesAsManyThreadsAsAskedFor) {
  for (int threads : {3, 8, 2, 64, 1}) {
    SetThreads(threads);
    EXPECT_EQ(NumThreads(), threads);
    EXPECT_EQ(AtTheSameTime(threads), threads);
  }
  SetThreads(0);
  EXPECT_EQ(AtTheSameTime(NumThreads()), NumThreads());
}

TEST(SetThreads, RefusesNumbersThatNoMachineHas) {
  for (int threads : {-1, 1000000}) {
    EXPECT_EQ(testing::MessageOf<InvalidOptions>([&] { SetThreads(threads); }).substr(0, 30),
              "threads: must be 0 (all cores)");
  }
}

TEST(ParallelFor, CallsTheBodyOnceForEveryIndex) {
  for (const auto& calls : testing::OnThreads([] {
         std::vector<int> calls(1000, 0);
         ParallelFor(1000, [&](int i) { calls[i] += i + 1; });
         return calls;
       })) {
    std::vector<int> expected(1000);
    std::iota(expected.begin(), expected.end(), 1);
    EXPECT_EQ(calls, expected);
  }
  ParallelFor(0, [](int) { FAIL(); });
}

TEST(ParallelFor, RethrowsWhatABodyThrows) {
  for (const std::string& message : testing::OnThreads([] {
         return testing::MessageOf<std::runtime_error>([] {
           ParallelFor(100, [](int i) {
             if (i == 57) throw std::runtime_error("57");
           });
         });
       })) {
    EXPECT_EQ(message, "57");
  }
}

#ifdef __SANITIZE_THREAD__
// The annotations of base/fork_join.h must not hide races between bodies.
TEST(ParallelForDeathTest, LetsTheThreadSanitizerSeeARaceOfTwoBodies) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  constexpr int kExitCodeOfRaces = 66;
  const auto race = [] {
    SetThreads(2);
    int shared = 0;
    std::atomic<int> running{0};
    ParallelFor(2, [&](int) {
      ++shared;
      running.fetch_add(1, std::memory_order_relaxed);  // relaxed: orders nothing
      while (running.load(std::memory_order_relaxed) < 2) std::this_thread::yield();
    });
    std::exit(0);
  };
  EXPECT_EXIT(race(), ::testing::ExitedWithCode(kExitCodeOfRaces), "data race");
}
#endif

}  // namespace
}  // namespace shapespace
