#include "support/nearest_word.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace shapespace::tools {
namespace {

// Levenshtein's distance, row by row of its table.
size_t EditsBetween(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (size_t i = 0; i < a.size(); ++i) {
    size_t corner = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t above = row[j + 1];
      row[j + 1] = std::min({above + 1, row[j] + 1, corner + (a[i] == b[j] ? 0 : 1)});
      corner = above;
    }
  }
  return row.back();
}

}  // namespace

std::string NearestWord(const std::string& typed, const std::set<std::string>& words) {
  std::string nearest;
  size_t least = typed.size() / 3 + 1;
  for (const std::string& word : words) {
    const size_t edits = EditsBetween(typed, word);
    if (edits >= least) continue;
    least = edits;
    nearest = word;
  }
  return nearest;
}

}  // namespace shapespace::tools
