#ifndef SHAPESPACE_BASE_ERROR_H_
#define SHAPESPACE_BASE_ERROR_H_

#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace shapespace {

/// Base class of all exceptions of shapespace. `what()` is a sentence for the user that names the
/// file, the element and the remedy if there are any.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message, std::string option = {})
      : std::runtime_error(message), option_(std::move(option)) {}

  /// The option with which the call would do what it has refused, by the name that it has in an
  /// options struct, such as "allow_nonmanifold"; empty if there is none. `what()` says what the
  /// option does, and does not name it.
  const std::string& option() const { return option_; }

 private:
  std::string option_;
};

/// A file cannot be opened, read to its end, understood or written.
class FileError : public Error {
 public:
  using Error::Error;
  FileError(const std::string& message, std::error_code cause) : Error(message), cause_(cause) {}

  /// Why the system refused the file, such as `std::errc::no_such_file_or_directory`; zero if it
  /// did not.
  std::error_code cause() const { return cause_; }

 private:
  std::error_code cause_;
};

/// A mesh was read but is not usable: index out of range, non-manifold edge, empty.
class MeshError : public Error {
 public:
  using Error::Error;
};

/// Meshes that should be poses of one connectivity are not.
class MismatchError : public Error {
 public:
  using Error::Error;
};

/// A field of an options struct, or an argument, has a value outside its range. `what()` is
/// "fields: problem", the fields separated by commas, or the problem alone if there is no field.
class InvalidOptions : public Error {
 public:
  InvalidOptions(std::vector<std::string> fields, const std::string& problem)
      : Error(Joined(fields) + problem), fields_(std::move(fields)), problem_(problem) {}
  InvalidOptions(const std::string& field, const std::string& problem)
      : InvalidOptions(std::vector<std::string>(field.empty() ? 0 : 1, field), problem) {}

  const std::vector<std::string>& fields() const { return fields_; }
  const std::string& problem() const { return problem_; }

 private:
  static std::string Joined(const std::vector<std::string>& fields) {
    std::string text;
    for (const std::string& field : fields) text += (text.empty() ? "" : ", ") + field;
    return text.empty() ? text : text + ": ";
  }

  std::vector<std::string> fields_;
  std::string problem_;
};

/// A solver cannot start or continue: a singular matrix, an estimate above the memory limit. (A
/// solver that does not converge reports it in its summary and throws nothing.)
class SolverError : public Error {
 public:
  using Error::Error;
};

/// A `Progress` asked a long call to stop; there is no partial result.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

}  // namespace shapespace

#endif  // SHAPESPACE_BASE_ERROR_H_
