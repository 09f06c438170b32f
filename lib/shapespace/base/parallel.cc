#include <shapespace/base/parallel.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/core_quota.h>
#include <shapespace/base/internal/fork_join.h>

namespace shapespace {
namespace {

// The threads used by ParallelFor.
struct ThreadPool {
  // By default TBB creates no more threads than there are cores.
  std::unique_ptr<tbb::global_control> more_than_cores;
  tbb::task_arena arena;
};

std::mutex pool_mutex;
std::shared_ptr<ThreadPool> pool;

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
  return result;
}

std::shared_ptr<ThreadPool> CurrentPool() {
  std::lock_guard<std::mutex> lock(pool_mutex);
  if (!pool) pool = NewPool(0);
  return pool;
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

int NumThreads() { return CurrentPool()->arena.max_concurrency(); }

void ParallelFor(int count, const std::function<void(int)>& body) {
  const auto current = CurrentPool();
  tbb::task_arena& arena = current->arena;
  if (count <= 1 || arena.max_concurrency() == 1) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  const internal::ForkJoin bodies{};
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count, 1),
        [&](const tbb::blocked_range<int>& r) {
          const internal::ForkJoin::Piece piece(bodies);
          for (int i = r.begin(); i != r.end(); ++i) body(i);
        },
        tbb::simple_partitioner());
  });
}

}  // namespace shapespace
