#ifndef SHAPESPACE_EXPLORATION_DETAIL_RECORDS_H_
#define SHAPESPACE_EXPLORATION_DETAIL_RECORDS_H_

#include <optional>
#include <string>
#include <utility>

// A cache of finished results on disk.

namespace shapespace::internal {

/// A folder of results, named by the digest of their inputs. Each is written completely or not at
/// all, so that a process may be killed at any time; other inputs have other names.
class Records {
 public:
  /// `folder` is created when needed; empty: nothing is stored.
  explicit Records(std::string folder) : folder_(std::move(folder)) {}

  /// The bytes of a record, if it exists and can be read.
  std::optional<std::string> Find(const std::string& digest) const;
  /// \throw FileError.
  void Keep(const std::string& digest, const std::string& bytes) const;
  /// Removes all records, incomplete files of killed processes, and the folder if it is then empty.
  void Remove() const;

 private:
  std::string File(const std::string& digest) const;

  const std::string folder_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPLORATION_DETAIL_RECORDS_H_
