#include <shapespace/base/parallel.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

#include <shapespace/base/detail/core_quota.h>
#include <shapespace/base/error.h>
#include <shapespace/base/internal/fork_join.h>
#include <shapespace/base/internal/system.h>

namespace shapespace {
namespace {

// Prepares the threads that TBB makes.
class Preparation : public tbb::task_scheduler_observer {
 public:
  explicit Preparation(tbb::task_arena* arena) : tbb::task_scheduler_observer(*arena) {
    observe(true);
  }
  ~Preparation() override { observe(false); }
  void on_scheduler_entry(bool /*is_worker*/) override { internal::PrepareThread(); }
};

// The threads of all loops and tasks.
struct ThreadPool {
  int NumThreads() const { return arena.max_concurrency(); }

  // By default TBB creates no more threads than there are cores.
  std::unique_ptr<tbb::global_control> more_than_cores;
  tbb::task_arena arena;
  std::optional<Preparation> preparation;
  std::atomic<int> tasks{0};  // bodies of ParallelTasks that are running
};

std::mutex pool_mutex;
std::shared_ptr<ThreadPool> pool;

// The pool to which the calling thread belongs, while it runs a body.
thread_local ThreadPool* own_pool = nullptr;

// Those that the process may use: TBB knows its affinity, but no quota of a container.
int NumCores() {
  const int cores = tbb::info::default_concurrency();
  const std::optional<double> quota = internal::CoreQuota();
  return quota ? std::clamp(static_cast<int>(std::ceil(*quota)), 1, cores) : cores;
}

std::shared_ptr<ThreadPool> NewPool(int threads) {
  auto result = std::make_shared<ThreadPool>();
  if (threads > tbb::info::default_concurrency()) {
    result->more_than_cores = std::make_unique<tbb::global_control>(
        tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  }
  result->arena.initialize(threads == 0 ? NumCores() : threads);
  result->preparation.emplace(&result->arena);
  return result;
}

std::shared_ptr<ThreadPool> CurrentPool() {
  std::lock_guard<std::mutex> lock(pool_mutex);
  if (!pool) pool = NewPool(0);
  return pool;
}

// The pool of a loop or of tasks.
struct PoolForCall {
  PoolForCall() : current(own_pool == nullptr ? CurrentPool() : nullptr) {}

  // Whether no thread is idle. If the calling thread is not one of the pool, it does not wait for
  // its threads either: tasks may be waiting for it.
  bool IsSerial() const {
    const int idle_from = own_pool == nullptr ? 1 : pool->NumThreads();
    return pool->NumThreads() == 1 || pool->tasks >= idle_from;
  }

  const std::shared_ptr<ThreadPool> current;
  ThreadPool* const pool = own_pool == nullptr ? current.get() : own_pool;
};

// Counts something while it exists.
class Counted {
 public:
  explicit Counted(std::atomic<int>* count) : count_(*count) { ++count_; }
  Counted(const Counted&) = delete;
  ~Counted() { --count_; }

 private:
  std::atomic<int>& count_;
};

// What was thrown by the bodies of one call.
class Failures {
 public:
  // Calls body(i), unless one with a lower index has failed.
  void Try(int i, const std::function<void(int)>& body) {
    if (i > lowest_) return;
    try {
      body(i);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (i > lowest_) return;
      lowest_ = i;
      thrown_ = std::current_exception();
    }
  }

  // Rethrows what the body with the lowest index threw, as a serial loop would.
  void Rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  std::atomic<int> lowest_{std::numeric_limits<int>::max()};
  std::mutex mutex_;
  std::exception_ptr thrown_;
};

// Runs body(i), which must not throw, for every i in [0, count) on the threads of a pool. The
// caller may already be one of them.
template <typename Body>
void RunInPool(ThreadPool* pool, int count, const Body& body) {
  const internal::ForkJoin bodies{};
  tbb::parallel_for(
      tbb::blocked_range<int>(0, count, 1),
      [&](const tbb::blocked_range<int>& range) {
        const internal::ForkJoin::Piece piece(bodies);
        ThreadPool* const outer = std::exchange(own_pool, pool);
        for (int i = range.begin(); i != range.end(); ++i) body(i);
        own_pool = outer;
      },
      tbb::simple_partitioner());
}

}  // namespace

void SetThreads(int threads) {
  const int most = std::max(256, tbb::info::default_concurrency());
  if (threads < 0 || threads > most) {
    throw InvalidOptions("threads", "must be 0 (all cores) to " + std::to_string(most));
  }
  std::lock_guard<std::mutex> lock(pool_mutex);
  pool.reset();  // because TBB uses the smallest of several global_controls
  pool = NewPool(threads);
}

int NumThreads() { return CurrentPool()->NumThreads(); }

void ParallelFor(int count, const std::function<void(int)>& body) {
  const PoolForCall call;
  if (count <= 1 || call.IsSerial()) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  Failures failures;
  // A thread that waits for the others must not begin with something else, which could be another
  // solve that waits for this one.
  call.pool->arena.execute([&] {
    tbb::this_task_arena::isolate(
        [&] { RunInPool(call.pool, count, [&](int i) { failures.Try(i, body); }); });
  });
  failures.Rethrow();
}

void ParallelTasks(int count, int at_once, const std::function<void(int)>& body) {
  const PoolForCall call;
  std::atomic<int> next{0};
  Failures failures;
  const auto take_tasks = [&] {
    for (int i; (i = next++) < count;) failures.Try(i, body);
  };
  const int workers = call.IsSerial() ? 1 : std::min({count, at_once, call.pool->NumThreads()});
  if (workers <= 1) {
    take_tasks();
  } else {
    call.pool->arena.execute([&] {
      RunInPool(call.pool, workers, [&](int) {
        const Counted counted(&call.pool->tasks);
        // A task that waits in a loop, also in one of a library, does not begin with another task.
        tbb::this_task_arena::isolate(take_tasks);
      });
    });
  }
  failures.Rethrow();
}

}  // namespace shapespace
