#include <shapespace/base/internal/read_file.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "mesh/files.h"

namespace shapespace {
namespace {

using internal::ReadFile;
using testing::ExpectError;

using ReadFileTest = testing::FilesTest;

TEST_F(ReadFileTest, IsReadWhole) {
  const std::string content = std::string("a\0b\n", 4) + std::string(100000, 'c');
  EXPECT_EQ(ReadFile(File("a.txt", content)), content);
  EXPECT_EQ(ReadFile(Path("a.txt"), static_cast<int>(content.size())), content);
  ExpectError<FileError>([&] { ReadFile(Path("a.txt"), 100); }, {"a.txt", "larger than the 100"});
}

TEST_F(ReadFileTest, MessagesSayWhatIsWrongWithTheFile) {
  const auto message = [](const std::string& file, std::int64_t most) {
    std::error_code cause;
    std::string text = "nothing was thrown";
    try {
      ReadFile(file, most);
    } catch (const FileError& error) {
      text = error.what();
      cause = error.cause();
    }
    return std::make_pair(text, cause.value());
  };
  const std::string file = File("a.txt", "12345"), empty = File("b.txt", "");
  const std::string folder = std::filesystem::path(file).parent_path().string();
  EXPECT_EQ(message(file, 5), std::make_pair(std::string("nothing was thrown"), 0));
  EXPECT_EQ(message(file, 4),
            std::make_pair(file + ": is larger than the 4 bytes that such a file may have", 0));
  EXPECT_EQ(message(empty, 5), std::make_pair(empty + ": is empty", 0));
  EXPECT_EQ(message(folder, 5), std::make_pair(folder + ": is a folder; name a file", EISDIR));
  EXPECT_EQ(message(file + "x", 5),
            std::make_pair(file + "x: cannot be opened: " + std::generic_category().message(ENOENT),
                           ENOENT));
}

// The kernel says of such a file that it has 4096 bytes, and gives fewer.
TEST_F(ReadFileTest, OneThatShrinksMeanwhileIsRefused) {
  const std::string file = "/sys/kernel/mm/transparent_hugepage/enabled";
  std::error_code error;
  if (std::filesystem::file_size(file, error) != 4096 || error) {
    GTEST_SKIP() << "this system has no such file";
  }
  ExpectError<FileError>([&] { ReadFile(file); }, {file, "cannot be read to its end"});
}

TEST_F(ReadFileTest, OneThatGrowsMeanwhileIsRefused) {
  constexpr int kBytes = 1000000, kMostReads = 10000;
  const std::string file = File("a.txt", std::string(kBytes, 'a'));
  std::atomic<bool> stop = false;
  std::thread writer([&] {
    std::ofstream stream(file, std::ios::binary | std::ios::app);
    while (!stop) stream << 'b' << std::flush;
  });
  std::string told;
  for (int i = 0; i < kMostReads && told.empty(); ++i) {
    try {
      ReadFile(file);
    } catch (const FileError& refused) {
      told = refused.what();
    }
  }
  stop = true;
  writer.join();
  EXPECT_EQ(told, file + ": has grown while it was read; wait until it is written");
  EXPECT_GT(ReadFile(file).size(), static_cast<size_t>(kBytes));
}

}  // namespace
}  // namespace shapespace
