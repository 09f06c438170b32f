#include <shapespace/base/internal/atomic_file.h>

#include <fcntl.h>
#include <sys/resource.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <functional>
#include <future>
#include <set>
#include <string>
#include <system_error>
#include <thread>

#include <gtest/gtest.h>

#include <shapespace/base/detail/file_buffer.h>
#include <shapespace/base/error.h>

#include "mesh/files.h"
#include "support/message_of.h"

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
  internal::WriteFileAtomically(file, [&](std::ostream& out) {
    out << "after" << std::flush;
    EXPECT_EQ(testing::Content(file), "before");
  });
  EXPECT_EQ(testing::Content(file), "after");
  EXPECT_EQ(Count(), 1);
}

TEST_F(AtomicFileTest, AFailureLeavesNothingBehind) {
  const std::string file = File("a.txt", "before");
  EXPECT_THROW(internal::WriteFileAtomically(file, [](std::ostream&) { throw MeshError("no"); }),
               MeshError);
  EXPECT_THROW(internal::WriteFileAtomically(
                   file, [](std::ostream& out) { out.setstate(std::ios::badbit); }),
               FileError);
  EXPECT_EQ(testing::Content(file), "before");
  EXPECT_EQ(Count(), 1);
}

// In a folder where others may write, they could lay links under names that they foresee, and have
// the user's other files overwritten.
TEST_F(AtomicFileTest, TemporariesHaveNamesThatNobodyForesees) {
  const std::string file = Path("a.txt"), precious = File("precious.txt", "precious");
  std::filesystem::create_symlink(precious, file + ".part" + std::to_string(getpid()));
  std::filesystem::create_symlink(precious, file);
  std::set<std::string> names;
  for (int i = 0; i < 20; ++i) {
    internal::WriteFileAtomically(file, [&](std::ostream& out) {
      out << "new" << std::flush;
      for (const auto& entry : std::filesystem::directory_iterator(Path(""))) {
        if (!entry.is_symlink()) names.insert(entry.path().filename().string());
      }
    });
  }
  EXPECT_EQ(names.size(), 22u) << "20 temporaries, precious.txt, and a.txt";
  EXPECT_EQ(testing::Content(precious), "precious");
  EXPECT_EQ(testing::Content(file), "new");
  EXPECT_FALSE(std::filesystem::is_symlink(file));
}

TEST_F(AtomicFileTest, NewFilesHaveThePermissionsOfAllOthers) {
  std::ofstream(Path("plain")) << "x";
  internal::WriteFileAtomically(Path("atomic"), [](std::ostream& out) { out << "x"; });
  EXPECT_EQ(std::filesystem::status(Path("atomic")).permissions(),
            std::filesystem::status(Path("plain")).permissions());
}

TEST_F(AtomicFileTest, ContentOfAnySizeIsWrittenAndItsPositionKnown) {
  std::string content;
  for (int i = 0; i < 100000; ++i) content += std::to_string(i);
  internal::WriteFileAtomically(Path("long"), [&](std::ostream& out) {
    for (size_t k = 0; k < content.size();) {
      const size_t count = std::min<size_t>(1 + k % 100001, content.size() - k);
      out.write(&content[k], static_cast<std::streamsize>(count));
      k += count;
      ASSERT_EQ(out.tellp(), static_cast<std::streamoff>(k));
    }
    out.put('.');
  });
  EXPECT_EQ(testing::Content(Path("long")), content + ".");
}

TEST_F(AtomicFileTest, AFullDiskIsReported) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  internal::FileBuffer buffer(open("/dev/full", O_WRONLY));
  std::ostream stream(&buffer);
  stream << "x";
  EXPECT_FALSE(buffer.Close());
  EXPECT_EQ(buffer.Error(), ENOSPC);
}

// In place of a disk that is full after some bytes.
TEST_F(AtomicFileTest, WhatDoesNotFitIsReportedAndLeavesTheOldFile) {
  const std::string file = File("a.txt", "before");
  rlimit limit;
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit small = {100000, limit.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  std::string message;
  std::error_code cause;
  try {
    internal::WriteFileAtomically(file, [](std::ostream& out) { out << std::string(200000, 'x'); });
  } catch (const FileError& error) {
    message = error.what();
    cause = error.cause();
  }
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(message, file + ": writing failed: " + std::generic_category().message(EFBIG));
  EXPECT_EQ(cause, std::errc::file_too_large);
  EXPECT_EQ(testing::Content(file), "before");
  EXPECT_EQ(Count(), 1);
}

TEST_F(AtomicFileTest, MessagesNameTheFileAndTheCause) {
  const auto message = [](const std::string& file, const std::function<void(std::ostream&)>& body) {
    return testing::MessageOf<FileError>([&] { internal::WriteFileAtomically(file, body); });
  };
  const auto text = [](std::ostream& out) { out << "x"; };
  const auto reason = [](int number) { return std::generic_category().message(number); };
  const std::string file = File("a.txt", "before");
  EXPECT_TRUE(testing::Names(
      message(file, [](std::ostream& out) { out.setstate(std::ios::failbit); }), {file}));
  EXPECT_TRUE(testing::Names(message(file + "/b.txt", text), {file, "/b.txt:", reason(ENOTDIR)}));
  std::filesystem::create_directories(Path("folder/full"));
  EXPECT_TRUE(testing::Names(message(Path("folder"), text), {Path("folder"), reason(EISDIR)}));
  const std::string long_name = Path(std::string(250, 'n'));  // too long with what is appended
  EXPECT_TRUE(testing::Names(message(long_name, text), {long_name, reason(ENAMETOOLONG)}));
  EXPECT_EQ(Count(), 1);
}

TEST_F(AtomicFileTest, FoldersAreMadeOnTheWay) {
  const std::string file = Path("new/inner/a.txt");
  internal::WriteFileAtomically(file, [](std::ostream& out) { out << "x"; });
  internal::WriteFileAtomically(file, [](std::ostream& out) { out << "xy"; });
  EXPECT_EQ(testing::Content(file), "xy");
}

TEST_F(AtomicFileTest, ABufferKnowsItsPositionAndCannotBeMoved) {
  const std::string file = Path("b.txt");
  internal::FileBuffer buffer(open(file.c_str(), O_WRONLY | O_CREAT, 0600));
  std::ostream stream(&buffer);
  EXPECT_EQ(stream.tellp(), 0);
  stream << std::string(70000, 'a') << "bc" << std::flush;
  EXPECT_EQ(testing::Content(file).size(), 70002u);
  stream << 'd';
  EXPECT_EQ(testing::Content(file).size(), 70002u) << "what follows is in the buffer";
  EXPECT_EQ(stream.tellp(), 70003);
  EXPECT_EQ(buffer.pubseekoff(1, std::ios::cur), -1);
  EXPECT_EQ(buffer.pubseekoff(0, std::ios::beg), -1);
  EXPECT_EQ(buffer.pubseekoff(0, std::ios::end), -1);
  EXPECT_TRUE(buffer.Close());
  EXPECT_TRUE(buffer.Close());
  EXPECT_EQ(buffer.Error(), 0);
  EXPECT_EQ(testing::Content(file), std::string(70000, 'a') + "bcd");
}

TEST_F(AtomicFileTest, ABufferTellsTheFirstErrorOfSeveral) {
  const std::string file = File("c.txt", "before");
  const int descriptor = open(file.c_str(), O_RDONLY);
  internal::FileBuffer buffer(descriptor);
  std::ostream stream(&buffer);
  stream << 'x';
  EXPECT_EQ(buffer.Error(), 0);
  EXPECT_FALSE(stream.flush());
  EXPECT_EQ(buffer.Error(), EBADF);
  EXPECT_FALSE(buffer.Close());
  EXPECT_EQ(buffer.Error(), EBADF);
  EXPECT_EQ(testing::Content(file), "before");
}

TEST_F(AtomicFileTest, NothingIsLeftOfFilesThatAreAbandoned) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  const std::string half = File("half.txt", "before"), late = Path("late.txt");
  const auto abandon = [&] {
    std::promise<void> begun;
    std::thread([&] {
      internal::WriteFileAtomically(half, [&](std::ostream& out) {
        out << "half" << std::flush;
        begun.set_value();
        std::promise<void>().get_future().wait();
      });
    }).detach();
    begun.get_future().wait();
    if (Count() != 2) std::_Exit(1);  // the file, and its temporary
    internal::AbandonUnfinishedFiles();
    std::thread([&] {
      internal::WriteFileAtomically(late, [](std::ostream& out) { out << "late"; });
    }).detach();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::_Exit(Count() == 1 ? 0 : 2);
  };
  EXPECT_EXIT(abandon(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace shapespace
