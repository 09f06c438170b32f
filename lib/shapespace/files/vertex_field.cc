#include <shapespace/files/vertex_field.h>

#include <string_view>
#include <vector>

#include <shapespace/base/internal/extension.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/detail/read_formats.h>

namespace shapespace {
namespace {

using FieldReader = Eigen::VectorXd (*)(const std::string& file, const std::string& text,
                                        const std::string& name);

/// The reader of a mesh format whose vertices can have numbers with names; null of other files.
FieldReader FieldReaderOf(const std::string& file) {
  const std::string extension = internal::FileExtension(file);
  if (extension == ".ply") return internal::ReadPlyProperty;
  if (extension == ".vtk") return internal::ReadVtkField;
  if (extension == ".vtp") return internal::ReadVtpField;
  return nullptr;
}

}  // namespace

Eigen::VectorXd ReadVertexField(const std::string& source) {
  const size_t colon = source.rfind(':');
  const FieldReader read =
      colon == std::string::npos ? nullptr : FieldReaderOf(source.substr(0, colon));
  if (read != nullptr) {
    const std::string file = source.substr(0, colon), property = source.substr(colon + 1);
    if (property.empty()) throw FileError(source + ": name a property behind the colon");
    Eigen::VectorXd field = read(file, internal::ReadFile(file, internal::kMaxMeshBytes), property);
    for (int v = 0; v < field.size(); ++v) {
      if (!std::isfinite(field(v))) {
        throw FileError(file + ": property " + property + " of vertex " + std::to_string(v + 1) +
                        " is not a finite number");
      }
    }
    return field;
  }
  if (FieldReaderOf(source) != nullptr) {
    throw FileError(source + ": name the property of the vertices to read, as " + source + ":name");
  }
  std::string text = internal::ReadFile(source);
  internal::BlankByteOrderMark(&text);
  std::vector<double> numbers;
  internal::Lines lines(text);
  std::string_view line;
  while (lines.Next(&line)) {
    internal::LineWords words(internal::WithoutComment(line));
    if (words.Done()) continue;
    const internal::ElementName vertex = {"vertex", numbers.size() + 1};
    numbers.push_back(
        internal::FiniteNumber(words.Next(), "number", source, lines.Number(), vertex));
    if (!words.Done()) {
      internal::FailAt(source, lines.Number(), vertex.Text() + ": more than one number");
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(),
                                           static_cast<Eigen::Index>(numbers.size()));
}

}  // namespace shapespace
