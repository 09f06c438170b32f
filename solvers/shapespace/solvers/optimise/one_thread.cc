#include <shapespace/solvers/optimise/one_thread.h>

#include <dlfcn.h>

#include <mutex>

namespace shapespace::internal {
namespace {

// Functions of libraries that a program may be linked with or not; null where it is not.
using Get = int (*)();
using Set = void (*)(int);

template <typename Function>
Function Find(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, name));
}

Get BlasThreads() {
  static const Get function = Find<Get>("openblas_get_num_threads");
  return function;
}
Set SetBlasThreads() {
  static const Set function = Find<Set>("openblas_set_num_threads");
  return function;
}
// At most so many parallel regions of OpenMP within each other, of the calling thread.
Get Levels() {
  static const Get function = Find<Get>("omp_get_max_active_levels");
  return function;
}
Set SetLevels() {
  static const Set function = Find<Set>("omp_set_max_active_levels");
  return function;
}

std::mutex blas_mutex;
int blas_users = 0, blas_threads = 0;

}  // namespace

OneThread::OneThread() {
  if (BlasThreads() != nullptr && SetBlasThreads() != nullptr) {
    const std::lock_guard<std::mutex> lock(blas_mutex);
    if (blas_users++ == 0) {
      blas_threads = BlasThreads()();
      SetBlasThreads()(1);
    }
  }
  if (Levels() != nullptr && SetLevels() != nullptr) {
    levels_ = Levels()();
    SetLevels()(0);
  }
}

OneThread::~OneThread() {
  if (BlasThreads() != nullptr && SetBlasThreads() != nullptr) {
    const std::lock_guard<std::mutex> lock(blas_mutex);
    if (--blas_users == 0) SetBlasThreads()(blas_threads);
  }
  if (levels_ > 0) SetLevels()(levels_);
}

}  // namespace shapespace::internal
