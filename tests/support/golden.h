#ifndef SHAPESPACE_TESTS_SUPPORT_GOLDEN_H_
#define SHAPESPACE_TESTS_SUPPORT_GOLDEN_H_

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace shapespace::testing {

inline std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Expects that `text` is the content of the file `name` in tests/golden. With the environment
/// variable SHAPESPACE_WRITE_GOLDEN, the file is written instead.
inline void ExpectGolden(const std::string& name, const std::string& text) {
  const std::string file = SHAPESPACE_GOLDEN_DIR "/" + name;
  if (std::getenv("SHAPESPACE_WRITE_GOLDEN")) {
    std::ofstream(file, std::ios::binary) << text;
    return;
  }
  std::ifstream in(file, std::ios::binary);
  const std::string golden{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (text == golden) return;
  const std::vector<std::string> is = LinesOf(text), was = LinesOf(golden);
  size_t i = 0;
  while (i < is.size() && i < was.size() && is[i] == was[i]) ++i;
  ADD_FAILURE() << file << ':' << i + 1 << ": differs. There stands\n"
                << (i < was.size() ? was[i] : "(nothing)") << "\nand it would be\n"
                << (i < is.size() ? is[i] : "(nothing)")
                << "\nIf that is meant, ./dev golden writes the files anew.";
}

/// The content of a golden file: a text, and what is different in its variants.
class GoldenText {
 public:
  explicit GoldenText(const std::string& text) : content_(text) {
    const std::vector<std::string> lines = LinesOf(text);
    known_.insert(lines.begin(), lines.end());
  }

  /// Of a variant there are the lines that the first text does not have, and the number of them
  /// all.
  void Variant(const std::string& heading, const std::string& text) {
    const std::vector<std::string> lines = LinesOf(text);
    content_ += "\n== " + heading + " (" + std::to_string(lines.size()) + " lines)\n";
    for (const std::string& line : lines) {
      if (known_.count(line) == 0) content_ += line + '\n';
    }
  }

  const std::string& Content() const { return content_; }

 private:
  std::set<std::string> known_;
  std::string content_;
};

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_GOLDEN_H_
