#include <shapespace/statistics/pose_table.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <ostream>
#include <string_view>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/csv.h>
#include <shapespace/base/internal/quoted.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/display_names.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
namespace {

using internal::CsvCells;
using internal::WithoutBlanks;

std::string PoseNamed(const std::string& cell) { return DisplayNames({cell})[0]; }

std::string Cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char letter : text)
    cell += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return cell + '"';
}

}  // namespace

PoseTable ReadPoseTable(const std::string& file) {
  std::string text = internal::ReadFile(file);
  internal::BlankByteOrderMark(&text);
  PoseTable table;
  table.file = file;
  internal::Lines lines(text);
  std::string_view line;
  std::map<std::string, int> line_of;
  while (lines.Next(&line)) {
    if (WithoutBlanks(line).empty()) continue;
    std::vector<std::string> cells = CsvCells(line, file, lines.Number());
    if (table.columns.empty()) {
      if (cells.size() < 2) {
        const bool semicolons = line.find(';') != std::string_view::npos;
        internal::FailAt(
            file, lines.Number(),
            std::string("there is one column; the first has the names of the poses, "
                        "the others what is known of them, separated by commas") +
                (semicolons ? ", not by semicolons; numbers need decimal points" : ""));
      }
      table.columns.assign(cells.begin() + 1, cells.end());
      continue;
    }
    if (cells.size() != table.columns.size() + 1) {
      internal::FailAt(file, lines.Number(),
                       "there are " + std::to_string(cells.size()) + " cells, and " +
                           std::to_string(table.columns.size() + 1) + " in the first line" +
                           (cells.size() > table.columns.size() + 1
                                ? "; commas separate cells, numbers need decimal points"
                                : ""));
    }
    const auto [first, is_new] = line_of.emplace(PoseNamed(cells[0]), lines.Number());
    if (!is_new) {
      internal::FailAt(file, lines.Number(),
                       "the pose " + internal::Quoted(cells[0]) + " has a row already, in line " +
                           std::to_string(first->second));
    }
    table.poses.push_back(cells[0]);
    table.lines.push_back(lines.Number());
    table.cells.emplace_back(cells.begin() + 1, cells.end());
  }
  if (table.poses.empty()) throw FileError(file + ": there is no row with a pose");
  return table;
}

std::vector<int> PoseTable::RowsOf(const std::vector<std::string>& names) const {
  std::map<std::string, int> row_of;
  for (size_t i = 0; i < poses.size(); ++i) row_of.emplace(PoseNamed(poses[i]), i);
  std::vector<int> rows;
  for (const std::string& name : names) {
    const auto found = row_of.find(PoseNamed(name));
    if (found == row_of.end()) {
      throw FileError(file + ": there is no row for the pose " + internal::Quoted(name) +
                      "; add one, or leave the pose out");
    }
    rows.push_back(found->second);
  }
  return rows;
}

Eigen::MatrixXd PoseTable::NumbersOf(const std::vector<std::string>& names) const {
  const std::vector<int> rows = RowsOf(names);
  Eigen::MatrixXd numbers(rows.size(), columns.size());
  for (size_t i = 0; i < rows.size(); ++i) {
    for (size_t j = 0; j < columns.size(); ++j) {
      const std::string& cell = cells[rows[i]][j];
      const std::optional<double> number = internal::ParseDouble(cell);
      if (!number || !std::isfinite(*number)) {
        internal::FailAt(file, lines[rows[i]],
                         columns[j] + " of the pose " + internal::Quoted(poses[rows[i]]) + ", " +
                             (internal::HasDecimalComma(cell)
                                  ? internal::NotANumber(cell)
                                  : internal::Quoted(cell) + ", is not a finite number"));
      }
      numbers(i, j) = *number;
    }
  }
  return numbers;
}

std::vector<std::string> PoseTable::LabelsOf(const std::vector<std::string>& names) const {
  std::vector<std::string> labels;
  for (const int row : RowsOf(names)) {
    if (cells[row][0].empty()) {
      internal::FailAt(file, lines[row],
                       columns[0] + " of the pose " + internal::Quoted(poses[row]) + " is empty");
    }
    labels.push_back(cells[row][0]);
  }
  return labels;
}

void WritePoseTable(const std::string& file, const std::vector<std::string>& poses,
                    const std::vector<std::string>& columns, const Eigen::MatrixXd& numbers) {
  if (numbers.rows() != static_cast<Eigen::Index>(poses.size()) ||
      numbers.cols() != static_cast<Eigen::Index>(columns.size())) {
    throw InvalidOptions("numbers", "must have a row for each pose and a column for each name");
  }
  std::string text = "pose";
  for (const std::string& column : columns) text += ',' + Cell(column);
  text += '\n';
  for (size_t i = 0; i < poses.size(); ++i) {
    text += Cell(poses[i]);
    for (size_t j = 0; j < columns.size(); ++j) text += internal::Format(",%.17g", numbers(i, j));
    text += '\n';
  }
  internal::WriteFileAtomically(file, [&](std::ostream& out) { out << text; });
}

}  // namespace shapespace
