#include <shapespace/base/parallel.h>

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
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

// Waits, but not for ever if the test fails.
void WaitUntil(const std::function<bool()>& is_true) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!is_true()) {
    if (std::chrono::steady_clock::now() > end) {
      ADD_FAILURE() << "waited in vain";
      return;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(20));
  }
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
    EXPECT_TRUE(testing::Names(
        testing::MessageOf<InvalidOptions>([&] { SetThreads(threads); }).substr(0, 30),
        {"threads:", "0"}));
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

// The message of an error does not depend on which thread was faster.
TEST(ParallelFor, RethrowsWhatTheLowestIndexThrows) {
  for (const std::string& message : testing::OnThreads([] {
         return testing::MessageOf<std::runtime_error>([] {
           ParallelFor(100, [](int i) {
             if (i == 7) testing::Spin(1000);
             if (i >= 7) throw std::runtime_error(std::to_string(i));
           });
         });
       })) {
    EXPECT_EQ(message, "7");
  }
}

// The processor may be shared with other programs, by taskset for example.
TEST(SetThreadsDeathTest, CountsTheCoresThatTheProcessMayUse) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a new process, in which TBB counts anew
  const auto count = [] {
    cpu_set_t allowed, one;
    CPU_ZERO(&allowed);
    CPU_ZERO(&one);
    sched_getaffinity(0, sizeof allowed, &allowed);
    int core = 0;
    while (!CPU_ISSET(core, &allowed)) ++core;
    CPU_SET(core, &one);
    sched_setaffinity(0, sizeof one, &one);
    std::exit(NumThreads());
  };
  EXPECT_EXIT(count(), ::testing::ExitedWithCode(1), "");
}

TEST(ParallelTasks, BeginInOrderAtMostSoManyAtATime) {
  for (const int at_once : {1, 2, 5, 100}) {
    for (const auto& [most, in_order] : testing::OnThreads([&] {
           std::atomic<int> begun{0}, running{0}, most{0};
           std::atomic<bool> in_order{true};
           ParallelTasks(50, at_once, [&](int i) {
             const int now = ++running;
             for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) continue;
             // Others may have begun between this one's beginning and here.
             if (std::abs(i - begun++) >= std::min(at_once, NumThreads())) in_order = false;
             testing::Spin(20);
             --running;
           });
           return std::make_pair(most.load(), in_order && begun == 50);
         })) {
      EXPECT_LE(most, at_once);
      EXPECT_TRUE(in_order);
    }
  }
}

TEST(ParallelTasks, RunOnAllThreads) {
  SetThreads(3);
  std::atomic<int> running{0};
  ParallelTasks(3, 3, [&](int) {
    ++running;
    WaitUntil([&] { return running == 3; });
  });
  SetThreads(0);
  EXPECT_EQ(running, 3);
}

// While every thread has a task, a loop in one of them is serial; when threads are idle, they help.
TEST(ParallelTasks, IdleThreadsHelpWithTheLoopsOfOthers) {
  SetThreads(3);
  std::atomic<int> running{0}, ended{0};
  std::set<std::thread::id> while_all_run, at_the_end;
  std::mutex mutex;
  ParallelTasks(3, 3, [&](int i) {
    ++running;
    WaitUntil([&] { return running == 3; });
    const auto loop = [&](std::set<std::thread::id>* threads) {
      std::atomic<int> inside{0};
      ParallelFor(300, [&](int) {
        ++inside;
        const std::lock_guard<std::mutex> lock(mutex);
        threads->insert(std::this_thread::get_id());
      });
      EXPECT_EQ(inside, 300);
    };
    if (i == 1) loop(&while_all_run);
    ++ended;
    WaitUntil([&] { return ended == 3; });
    if (i > 0) return;
    WaitUntil([&] {
      loop(&at_the_end);
      return at_the_end.size() > 1;
    });
  });
  SetThreads(0);
  EXPECT_EQ(while_all_run.size(), 1u);
  EXPECT_GT(at_the_end.size(), 1u);
}

// A thread that waits for its loop must not begin another task in the meantime: with a lock held,
// it would wait for itself.
TEST(ParallelTasks, DoNotBeginWithinTheLoopOfAnother) {
  SetThreads(8);
  for (const bool nested : {false, true}) {
    std::atomic<bool> overlapped{false};
    const auto task = [&](int) {
      thread_local bool inside = false;
      if (inside) overlapped = true;
      inside = true;
      const std::thread::id owner = std::this_thread::get_id();
      // Others take longer, so that the owner waits for them.
      const auto body = [&](int) { testing::Spin(std::this_thread::get_id() == owner ? 5 : 200); };
      for (int round = 0; round < 20; ++round) {
        ParallelFor(8, body);
      }
      inside = false;
    };
    if (nested) {
      ParallelFor(20, task);
    } else {
      ParallelTasks(20, 20, task);
    }
    EXPECT_FALSE(overlapped);
  }
  SetThreads(0);
}

// Otherwise a callback that waits for another thread could wait for a loop that waits for threads
// whose tasks wait for the callback.
TEST(ParallelTasks, DoNotLetOtherThreadsWaitForThem) {
  SetThreads(3);
  std::set<std::thread::id> threads;
  std::mutex mutex;
  ParallelTasks(2, 2, [&](int i) {
    if (i > 0) return;
    std::thread([&] {
      const auto body = [&](int) {
        testing::Spin(20);
        const std::lock_guard<std::mutex> lock(mutex);
        threads.insert(std::this_thread::get_id());
      };
      for (int round = 0; round < 50; ++round) ParallelFor(16, body);
      ParallelTasks(16, 16, body);
    }).join();
  });
  SetThreads(0);
  EXPECT_EQ(threads.size(), 1u);
}

// As a callback in another thread does, which runs loops of its own.
TEST(ParallelTasks, MayWaitForOtherThreadsThatRunLoops) {
  SetThreads(2);
  std::atomic<int> running{0}, sum{0};
  ParallelTasks(2, 2, [&](int) {
    ++running;
    WaitUntil([&] { return running == 2; });
    std::thread([&] {
      ParallelFor(10, [&](int i) { sum += i; });
      ParallelTasks(10, 10, [&](int i) { sum += i; });
    }).join();
  });
  SetThreads(0);
  EXPECT_EQ(sum, 2 * 2 * 45);
}

TEST(ParallelTasks, EndWhenOneFailsWithWhatItThrows) {
  for (const auto& [message, later] : testing::OnThreads([] {
         std::atomic<int> later{0};
         const std::string message = testing::MessageOf<std::runtime_error>([&] {
           std::atomic<int> begun{0};
           const int workers = std::min(8, NumThreads());
           ParallelTasks(1000, 8, [&](int i) {
             ++begun;
             if (i < workers) WaitUntil([&] { return begun >= workers; });
             if (i == 20) throw std::runtime_error("20");
             if (i > 20) ++later;
             if (i > 20) testing::Spin(100);
           });
         });
         return std::make_pair(message, later.load());
       })) {
    EXPECT_EQ(message, "20");
    EXPECT_LT(later, 900);
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
