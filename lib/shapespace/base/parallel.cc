#include <shapespace/base/parallel.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <string>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <shapespace/base/error.h>

#ifdef SHAPESPACE_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace shapespace {
namespace {

// What the thread sanitizer is told of one ParallelFor: all bodies come after its beginning, and
// its end comes after all bodies. Nothing orders the bodies among themselves.
#ifdef SHAPESPACE_THREAD_SANITIZER
class Order {
 public:
  Order() { __tsan_release(&begin_); }
  ~Order() { __tsan_acquire(&end_); }

  class Body {
   public:
    explicit Body(Order* order) : order_(order) { __tsan_acquire(&order_->begin_); }
    ~Body() { __tsan_release(&order_->end_); }

   private:
    Order* order_;
  };

 private:
  char begin_, end_;
};
#else
struct Order {
  struct Body {
    explicit Body(Order*) {}
  };
};
#endif

// The threads that work is spread over.
struct Pool {
  // TBB makes no more threads in a process than there are cores, unless it is told.
  std::unique_ptr<tbb::global_control> more_than_cores;
  tbb::task_arena arena;
};

std::mutex pool_mutex;
std::shared_ptr<Pool> pool;

std::shared_ptr<Pool> NewPool(int threads) {
  auto result = std::make_shared<Pool>();
  if (threads > tbb::info::default_concurrency()) {
    result->more_than_cores = std::make_unique<tbb::global_control>(
        tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  }
  result->arena.initialize(threads == 0 ? tbb::task_arena::automatic : threads);
  return result;
}

std::shared_ptr<Pool> CurrentPool() {
  std::lock_guard<std::mutex> lock(pool_mutex);
  if (!pool) pool = NewPool(0);
  return pool;
}

}  // namespace

void SetThreads(int threads) {
  const int most = std::max(256, tbb::info::default_concurrency());
  if (threads < 0 || threads > most) {
    throw InvalidOptions("threads: must be 0 (all cores) to " + std::to_string(most));
  }
  std::lock_guard<std::mutex> lock(pool_mutex);
  pool.reset();  // of several global_controls TBB takes the smallest
  pool = NewPool(threads);
}

int Threads() { return CurrentPool()->arena.max_concurrency(); }

void ParallelFor(int count, const std::function<void(int)>& body) {
  const auto current = CurrentPool();
  tbb::task_arena& arena = current->arena;
  if (count <= 1 || arena.max_concurrency() == 1) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  Order order;
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count, 1),
        [&](const tbb::blocked_range<int>& r) {
          const Order::Body ordered(&order);
          for (int i = r.begin(); i != r.end(); ++i) body(i);
        },
        tbb::simple_partitioner());
  });
}

}  // namespace shapespace
