#ifndef SHAPESPACE_STATISTICS_POSE_TABLE_H_
#define SHAPESPACE_STATISTICS_POSE_TABLE_H_

#include <string>
#include <vector>

#include <Eigen/Core>

namespace shapespace {

/// A table of what is known of poses: a CSV file, as R, pandas and spreadsheets read and write it.
/// The first line has the names of the columns; the first column has the names of the poses or of
/// their files.
struct PoseTable {
  std::string file;                             ///< for messages
  std::vector<std::string> columns;             ///< but for the first
  std::vector<std::string> poses;               ///< the first column
  std::vector<int> lines;                       ///< of the rows in the file, for messages
  std::vector<std::vector<std::string>> cells;  ///< of each row, one per column

  /// The row of each pose of `names`. A pose is named as it is, or as a file with any folder and
  /// extension. Rows of other poses are passed over.
  /// \throw FileError naming a pose that has no row.
  std::vector<int> RowsOf(const std::vector<std::string>& names) const;

  /// The numbers of all columns for `names`: a row for each pose.
  /// \throw FileError as `RowsOf`, or naming the line and the cell that is not a finite number.
  Eigen::MatrixXd NumbersOf(const std::vector<std::string>& names) const;

  /// The words of the first column of `columns` for `names`.
  /// \throw FileError as `RowsOf`, or naming an empty cell.
  std::vector<std::string> LabelsOf(const std::vector<std::string>& names) const;
};

/// Reads a table: cells are separated by commas, and may be enclosed in double quotes.
/// \throw FileError naming the file and the line: a row of another number of cells, a pose that
///        occurs twice, an unfinished quote, or no row at all.
PoseTable ReadPoseTable(const std::string& file);

/// Writes numbers for poses, with all digits; completely or not at all.
/// \throw FileError; InvalidOptions if there are not as many rows and columns as names.
void WritePoseTable(const std::string& file, const std::vector<std::string>& poses,
                    const std::vector<std::string>& columns, const Eigen::MatrixXd& numbers);

}  // namespace shapespace

#endif  // SHAPESPACE_STATISTICS_POSE_TABLE_H_
