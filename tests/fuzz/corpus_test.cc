// Every file of the corpus, and each of them cut off in the middle, through its target. Findings of
// libFuzzer (tests/fuzz/run.sh) become files of the corpus.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "fuzz/targets.h"

namespace shapespace::fuzz {
namespace {

class CorpusTest : public ::testing::TestWithParam<Target> {};

TEST_P(CorpusTest, IsTakenOrRefused) {
  const std::filesystem::path folder = std::filesystem::path(SHAPESPACE_CORPUS) / GetParam().name;
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().filename());
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(stream), {});
    EXPECT_NO_THROW(RunOn(GetParam(), bytes));
    EXPECT_NO_THROW(RunOn(GetParam(), bytes.substr(0, bytes.size() / 2)));
    ++files;
  }
  EXPECT_GT(files, 0);
}

std::string NameOf(const ::testing::TestParamInfo<Target>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Readers, CorpusTest, ::testing::ValuesIn(Readers()), NameOf);
INSTANTIATE_TEST_SUITE_P(Solvers, CorpusTest, ::testing::ValuesIn(Solvers()), NameOf);

}  // namespace
}  // namespace shapespace::fuzz
