#ifndef SHAPESPACE_PATH_INTERNAL_ARRAY_FILE_H_
#define SHAPESPACE_PATH_INTERNAL_ARRAY_FILE_H_

#include <cstdint>
#include <cstring>
#include <exception>
#include <map>
#include <new>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/read_file.h>

// The layout shared by shapespace's own file formats. A JSON header describes the arrays
// that follow it, which contain numbers in binary form, with one checksum (docs/file-formats.md).

namespace shapespace::internal {

using HeaderJson = nlohmann::ordered_json;

/// A kind of file.
struct ArrayFileKind {
  char magic[9];  ///< eight letters
  uint32_t version;
  const char* name;  ///< as used in messages: ".path"
};

/// Collects the arrays that follow the header, in order.
class ArrayWriter {
 public:
  template <typename Scalar>
  void Add(const std::string& name, const Scalar* data, size_t rows, size_t columns) {
    AddToTable<Scalar>(name, rows, columns);
    parts_.push_back({{reinterpret_cast<const char*>(data), rows * columns * sizeof(Scalar)}, {}});
  }
  template <typename Matrix>
  void Add(const std::string& name, const Matrix& matrix) {
    Add(name, matrix.data(), matrix.rows(), matrix.cols());
  }
  /// As `Add`, without a copy: `matrix` must outlive this object.
  template <typename Matrix>
  void AddReference(const std::string& name, const Matrix& matrix) {
    AddToTable<typename Matrix::Scalar>(name, matrix.rows(), matrix.cols());
    parts_.push_back({{},
                      {reinterpret_cast<const char*>(matrix.data()),
                       matrix.size() * sizeof(typename Matrix::Scalar)}});
  }
  const HeaderJson& Table() const { return table_; }
  /// Calls visit(bytes) for all arrays, in order.
  template <typename Visit>
  void ForBytes(const Visit& visit) const {
    for (const Part& part : parts_) {
      visit(part.referred.data() != nullptr ? part.referred : std::string_view(part.own));
    }
  }

 private:
  struct Part {
    std::string own;
    std::string_view referred;
  };

  template <typename Scalar>
  void AddToTable(const std::string& name, size_t rows, size_t columns) {
    static_assert(std::is_same_v<Scalar, double> || std::is_same_v<Scalar, int>);
    const char* const type = std::is_same_v<Scalar, double> ? "f8" : "i4";
    table_.push_back({{"name", name}, {"type", type}, {"rows", rows}, {"columns", columns}});
  }

  HeaderJson table_ = HeaderJson::array();
  std::vector<Part> parts_;
};

class ArrayReader {
 public:
  /// `table` describes arrays that occupy `bytes` from `begin` to the end.
  ArrayReader(const HeaderJson& table, const std::string& bytes, size_t begin);

  bool Has(const std::string& name) const { return arrays_.count(name) > 0; }

  /// A matrix of `rows` x `columns`; either may be Eigen::Dynamic for any.
  /// \throw FileError if there is no array of that name, type and size, or it contains a number
  ///        that is not finite.
  template <typename Matrix>
  Matrix Get(const std::string& name, Eigen::Index rows, Eigen::Index columns) const {
    using Scalar = typename Matrix::Scalar;
    const auto found = arrays_.find(name);
    if (found == arrays_.end()) throw FileError("it lacks the array " + name);
    const Array& array = found->second;
    const bool fits = array.type == (std::is_same_v<Scalar, double> ? "f8" : "i4") &&
                      (rows == Eigen::Dynamic || static_cast<size_t>(rows) == array.rows) &&
                      (columns == Eigen::Dynamic || static_cast<size_t>(columns) == array.columns);
    if (!fits) throw FileError("its array " + name + " has the wrong type or size");
    Matrix matrix(array.rows, array.columns);
    // An empty matrix may have a null address, which is not permitted in memcpy.
    if (matrix.size() > 0) {
      std::memcpy(matrix.data(), bytes_.data() + array.begin, matrix.size() * sizeof(Scalar));
    }
    if constexpr (std::is_same_v<Scalar, double>) {
      if (!matrix.allFinite()) throw FileError("its array " + name + " holds a non-finite number");
    }
    return matrix;
  }

 private:
  struct Array {
    std::string type;
    size_t rows, columns, begin;
  };
  const std::string& bytes_;
  std::map<std::string, Array> arrays_;
};

/// The whole file as bytes; the table of `arrays` is added to `header`.
std::string PackArrayFile(const ArrayFileKind& kind, HeaderJson header, const ArrayWriter& arrays);

/// Reads the header at the beginning of `bytes`, a whole file, and the position of the arrays.
/// \throw FileError, without the file's name: another kind of file, another version, truncated or
///        damaged (its checksum does not fit).
HeaderJson UnpackHeader(const ArrayFileKind& kind, const std::string& bytes, size_t* arrays_begin);

/// Writes a file of this layout, completely or not at all.
/// \throw FileError.
void WriteArrayFile(const std::string& file, const ArrayFileKind& kind, HeaderJson header,
                    const ArrayWriter& arrays);

/// Returns parse(header, arrays) for a file.
/// \throw FileError naming the file, for any error in it; std::bad_alloc, for which the file is not
///        to blame, because no size in it is believed before the file is known to be as large.
template <typename Parse>
auto ReadArrayFile(const std::string& file, const ArrayFileKind& kind, const Parse& parse) {
  const std::string bytes = ReadFile(file);
  try {
    size_t begin;
    const HeaderJson header = UnpackHeader(kind, bytes, &begin);
    return parse(header, ArrayReader(header.at("arrays"), bytes, begin));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw FileError(file + ": " + error.what());
  }
}

/// How many there are of something, by the name of a field of a header.
/// \throw FileError, without the file's name, if it is no integer from 0 to 2^31 - 1.
int CountFrom(const HeaderJson& header, const char* name);

/// The entries of an integer array with one column.
std::vector<int> IndicesFrom(const ArrayReader& arrays, const std::string& name);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_PATH_INTERNAL_ARRAY_FILE_H_
