#ifndef SHAPESPACE_BASE_ERROR_H_
#define SHAPESPACE_BASE_ERROR_H_

#include <stdexcept>
#include <string>

namespace shapespace {

/// Base class of all exceptions of shapespace. `what()` is a sentence for the user that names the
/// file, the element and the remedy if there are any.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file cannot be opened, read to its end, understood or written.
class FileError : public Error {
 public:
  using Error::Error;
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

/// An options struct holds a value outside its range; the message begins with the field's name.
class InvalidOptions : public Error {
 public:
  using Error::Error;
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
