#ifndef SHAPESPACE_SOLVERS_EXPLORATION_RECORDS_H_
#define SHAPESPACE_SOLVERS_EXPLORATION_RECORDS_H_

#include <optional>
#include <string>
#include <utility>

// Private: finished work on disk.

namespace shapespace::internal {

/// A folder of results by the digest of what they were made from. Each appears whole or not at all,
/// so that a process may be killed at any time; what was made from anything else has another name.
class Records {
 public:
  /// `folder` is made when it is needed; empty: nothing is kept.
  explicit Records(std::string folder) : folder_(std::move(folder)) {}

  /// The bytes of a record, if it is there and can be read.
  std::optional<std::string> Find(const std::string& digest) const;
  /// \throw FileError.
  void Keep(const std::string& digest, const std::string& bytes) const;
  /// Removes all records, what a killed process left half-written, and the folder if nothing else
  /// is in it.
  void Remove() const;

 private:
  std::string File(const std::string& digest) const;

  const std::string folder_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_EXPLORATION_RECORDS_H_
