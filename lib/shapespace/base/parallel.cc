#include <shapespace/base/parallel.h>

#include <algorithm>
#include <memory>
#include <mutex>

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <shapespace/base/error.h>

namespace shapespace {
namespace {

std::mutex arena_mutex;
std::shared_ptr<tbb::task_arena> arena;

std::shared_ptr<tbb::task_arena> Arena() {
  std::lock_guard<std::mutex> lock(arena_mutex);
  if (!arena) arena = std::make_shared<tbb::task_arena>();
  return arena;
}

}  // namespace

void SetThreads(int threads) {
  if (threads < 0) throw InvalidOptions("threads: must be 0 (all cores) or more");
  const int cores = tbb::info::default_concurrency();
  auto replacement =
      std::make_shared<tbb::task_arena>(threads == 0 ? cores : std::min(threads, cores));
  std::lock_guard<std::mutex> lock(arena_mutex);
  arena = std::move(replacement);
}

int Threads() { return Arena()->max_concurrency(); }

void ParallelFor(int count, const std::function<void(int)>& body) {
  const auto current = Arena();
  if (count <= 1 || current->max_concurrency() == 1) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  current->execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count, 1),
        [&](const tbb::blocked_range<int>& r) {
          for (int i = r.begin(); i != r.end(); ++i) body(i);
        },
        tbb::simple_partitioner());
  });
}

}  // namespace shapespace
