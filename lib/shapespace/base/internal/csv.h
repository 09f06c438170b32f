#ifndef SHAPESPACE_BASE_INTERNAL_CSV_H_
#define SHAPESPACE_BASE_INTERNAL_CSV_H_

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <shapespace/base/internal/text.h>

// Tables of values separated by commas.

namespace shapespace::internal {

/// Without the blanks around it.
inline std::string_view WithoutBlanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  return text.substr(0, text.find_last_not_of(" \t") + 1);
}

/// The cells of line `number` of a file (RFC 4180, but for line breaks within quotes).
/// \throw FileError naming file and line where quotes are not closed, or text follows them.
inline std::vector<std::string> CsvCells(std::string_view line, const std::string& file,
                                         int number) {
  std::vector<std::string> cells;
  for (size_t at = 0; at <= line.size();) {
    const size_t begin = std::min(line.find_first_not_of(" \t", at), line.size());
    if (begin == line.size() || line[begin] != '"') {
      const size_t end = std::min(line.find(',', at), line.size());
      cells.emplace_back(WithoutBlanks(line.substr(at, end - at)));
      at = end + 1;
      continue;
    }
    std::string cell;
    size_t end = begin + 1;
    for (;; ++end) {
      if (end >= line.size()) FailAt(file, number, "a quote does not end on this line");
      if (line[end] != '"') {
        cell += line[end];
      } else if (line.substr(end + 1, 1) == "\"") {
        cell += line[end++];
      } else {
        break;
      }
    }
    at = std::min(line.find(',', end), line.size());
    if (!WithoutBlanks(line.substr(end + 1, at - end - 1)).empty()) {
      FailAt(file, number, "there is text between a quote and the next comma");
    }
    cells.push_back(std::move(cell));
    ++at;
  }
  return cells;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_CSV_H_
