// What happens when memory cannot be had: the n-th allocation of a call fails, for many n. The call
// has to end with std::bad_alloc or an error of this library, without a leak, and must have left
// files alone. Files with JSON in them are not among the calls: the destructor of nlohmann::json
// allocates memory itself, and ends the program if there is none; nor are solves by Ceres, which
// does so too.

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <new>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/files/read.h>
#include <shapespace/files/write.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/output/frames.h>
#include <shapespace/statistics/average.h>
#include <shapespace/transfer/transfer.h>

#include "mesh/files.h"

extern "C" void* __libc_malloc(size_t);
extern "C" void* __libc_calloc(size_t, size_t);
extern "C" void* __libc_realloc(void*, size_t);
extern "C" void __libc_free(void*);

namespace {

// Allocations of this thread until one fails; none fails while it is negative.
thread_local long left = -1;
thread_local bool has_failed = false;
thread_local long blocks = 0;  // that this thread has, less those that it had of others

bool Fails() {
  if (left < 0 || left-- > 0) return false;
  has_failed = true;
  return true;
}

}  // namespace

// In place of those of the C library, which operator new and Eigen call.
extern "C" void* malloc(size_t size) {
  if (Fails()) return nullptr;
  ++blocks;
  return __libc_malloc(size);
}
extern "C" void* calloc(size_t count, size_t size) {
  if (Fails()) return nullptr;
  ++blocks;
  return __libc_calloc(count, size);
}
extern "C" void* realloc(void* block, size_t size) {
  if (Fails()) return nullptr;
  if (block == nullptr) ++blocks;
  return __libc_realloc(block, size);
}
extern "C" void free(void* block) {
  if (block != nullptr) --blocks;
  __libc_free(block);
}

namespace shapespace {
namespace {

class AllocationTest : public testing::FilesTest {
 protected:
  // On one thread every allocation is one of this thread.
  void SetUp() override {
    SetThreads(1);
    TubeForm form;
    const ShapeFamily tube = MakeTube(60, form);
    connectivity_ = tube.connectivity;
    poses_ = {tube.pose(0), tube.pose(40)};
  }
  void TearDown() override { SetThreads(0); }

  // Lets allocations of `call` fail, the first, the second and so on; after the thirtieth some are
  // passed over, more and more.
  void Refuse(const std::function<void()>& call) {
    call();  // what is made once and kept is made here
    int refused = 0;
    for (long n = 0;; n += 1 + n / 30) {
      const long before = blocks;
      has_failed = false;
      left = n;
      std::string wrong;
      try {
        call();
      } catch (const std::bad_alloc&) {
      } catch (const Error&) {
      } catch (const std::exception& error) {
        left = -1;
        wrong = error.what();
      }
      left = -1;
      EXPECT_EQ(wrong, "") << "allocation " << n;
      wrong.shrink_to_fit();
      // One block may be lost by Eigen, where a sparse matrix cannot be permuted for want of
      // memory.
      EXPECT_LE(blocks, before + 1) << "allocation " << n;
      if (!has_failed) break;
      ++refused;
    }
    EXPECT_GT(refused, 10);
  }

  std::shared_ptr<const Connectivity> connectivity_;
  std::vector<Shape> poses_;
};

GeodesicOptions Short() {
  GeodesicOptions options;
  options.shapes = 1;
  options.solver = GeodesicSolver::kThreadedLbfgs;
  options.assess = false;  // by Embree, which does not notice every failure
  return options;
}

TEST_F(AllocationTest, Readers) {
  const Soup soup = FrameSoup(*connectivity_, {});
  for (const char* file : {"a.obj", "a.ply", "a.off", "a.stl"}) {
    WriteMesh(Path(file), poses_[0], soup);
    Refuse([&] { ReadSoup(Path(file)); });
  }
}

TEST_F(AllocationTest, WritersLeaveTheOldFile) {
  const Soup soup = FrameSoup(*connectivity_, {});
  for (const char* file : {"a.obj", "a.ply"}) {
    WriteMesh(Path(file), poses_[0], soup);
    const std::string content = testing::Content(Path(file));
    Refuse([&] { WriteMesh(Path(file), poses_[0], soup); });
    EXPECT_EQ(testing::Content(Path(file)), content);
  }
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(Path(""))) {
    files.insert(entry.path().filename());
  }
  EXPECT_EQ(files, (std::set<std::string>{"a.obj", "a.ply"}));
}

TEST_F(AllocationTest, Geodesics) {
  Refuse([&] { Interpolate(connectivity_, poses_, Short()); });
}

TEST_F(AllocationTest, OtherSolvers) {
  const shapespace::Path path = Interpolate(connectivity_, poses_, Short()).path;
  Refuse([&] { Extrapolate(path, 1); });
  Refuse([&] { Transfer(path, 2 * poses_[0]); });
  AverageOptions average;
  average.geodesic = Short();
  Refuse([&] { Average(connectivity_, poses_, average); });
  DeformationHandle held, moved;
  held.vertices = {0};
  moved.vertices = {connectivity_->NumVertices() - 1};
  moved.motion.translation.z() = 1;
  Refuse([&] { Deform(connectivity_, poses_[0], {held, moved}); });
}

}  // namespace
}  // namespace shapespace
