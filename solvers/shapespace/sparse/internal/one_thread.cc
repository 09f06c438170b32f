#include <shapespace/sparse/internal/one_thread.h>

#include <mutex>

#include <shapespace/base/internal/system.h>

namespace shapespace::internal {
namespace {

// A setting of a library, if the program is linked with that library.
struct Setting {
  Setting(const char* get_name, const char* set_name)
      : get(reinterpret_cast<int (*)()>(FunctionOfProgram(get_name))),
        set(reinterpret_cast<void (*)(int)>(FunctionOfProgram(set_name))) {}
  bool Exists() const { return get != nullptr && set != nullptr; }

  int (*const get)();
  void (*const set)(int);
};

const Setting& BlasThreads() {
  static const Setting setting("openblas_get_num_threads", "openblas_set_num_threads");
  return setting;
}

// The calling thread's maximum number of nested parallel regions of OpenMP.
const Setting& Levels() {
  static const Setting setting("omp_get_max_active_levels", "omp_set_max_active_levels");
  return setting;
}

std::mutex blas_mutex;
int blas_users = 0, blas_threads = 0;

}  // namespace

OneThread::OneThread() {
  if (BlasThreads().Exists()) {
    const std::lock_guard<std::mutex> lock(blas_mutex);
    if (blas_users++ == 0) {
      blas_threads = BlasThreads().get();
      // Where the program has ended the threads, any call would start them again.
      if (blas_threads > 1) BlasThreads().set(1);
    }
  }
  if (Levels().Exists()) {
    levels_ = Levels().get();
    Levels().set(0);
  }
}

OneThread::~OneThread() {
  if (BlasThreads().Exists()) {
    const std::lock_guard<std::mutex> lock(blas_mutex);
    if (--blas_users == 0 && blas_threads > 1) BlasThreads().set(blas_threads);
  }
  if (Levels().Exists()) Levels().set(levels_);
}

}  // namespace shapespace::internal
