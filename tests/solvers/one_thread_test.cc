#include <shapespace/solvers/optimise/one_thread.h>

#include <dlfcn.h>

#include <optional>

#include <gtest/gtest.h>

namespace shapespace::internal {
namespace {

TEST(OneThread, GivesBlasItsThreadsBackWhenTheLastOneGoes) {
  const auto threads = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
  const auto set = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (threads == nullptr || set == nullptr) GTEST_SKIP() << "this program has another BLAS";
  const int original = threads();
  set(2);
  const int before = threads();  // 1 on a machine with one core
  {
    std::optional<OneThread> first;
    first.emplace();
    const OneThread second;
    EXPECT_EQ(threads(), 1);
    first.reset();
    EXPECT_EQ(threads(), 1);
  }
  EXPECT_EQ(threads(), before);
  set(original);
}

}  // namespace
}  // namespace shapespace::internal
