#include <shapespace/base/atomic_file.h>

#include <future>
#include <thread>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "mesh/files.h"

namespace shapespace {
namespace {

class AtomicFileTest : public testing::FilesTest {
 protected:
  /// Files in the test's folder.
  int Count() const {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(Path(""))) {
      count += entry.is_regular_file();
    }
    return count;
  }
};

TEST_F(AtomicFileTest, ReplacesWhatStoodThereAtTheEndOnly) {
  const std::string file = File("a.txt", "before");
  WriteFileAtomically(file, [&](std::ostream& out) {
    out << "after" << std::flush;
    EXPECT_EQ(testing::Content(file), "before");
  });
  EXPECT_EQ(testing::Content(file), "after");
  EXPECT_EQ(Count(), 1);
}

TEST_F(AtomicFileTest, AFailureLeavesNothingBehind) {
  const std::string file = File("a.txt", "before");
  EXPECT_THROW(WriteFileAtomically(file, [](std::ostream&) { throw MeshError("no"); }), MeshError);
  EXPECT_THROW(WriteFileAtomically(file, [](std::ostream& out) { out.setstate(std::ios::badbit); }),
               FileError);
  EXPECT_EQ(testing::Content(file), "before");
  EXPECT_EQ(Count(), 1);
}

TEST_F(AtomicFileTest, NothingIsLeftOfFilesThatAreAbandoned) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  const std::string half = File("half.txt", "before"), late = Path("late.txt");
  const auto abandon = [&] {
    std::promise<void> begun;
    std::thread([&] {
      WriteFileAtomically(half, [&](std::ostream& out) {
        out << "half" << std::flush;
        begun.set_value();
        std::promise<void>().get_future().wait();
      });
    }).detach();
    begun.get_future().wait();
    if (Count() != 2) std::_Exit(1);  // the file, and its temporary
    AbandonUnfinishedFiles();
    std::thread([&] {
      WriteFileAtomically(late, [](std::ostream& out) { out << "late"; });
    }).detach();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::_Exit(Count() == 1 ? 0 : 2);
  };
  EXPECT_EXIT(abandon(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace shapespace
