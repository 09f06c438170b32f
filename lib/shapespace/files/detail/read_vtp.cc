#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/detail/number_type.h>
#include <shapespace/files/detail/read_formats.h>
#include <shapespace/files/detail/vtk_mesh.h>
#include <shapespace/files/detail/vtp_bytes.h>
#include <shapespace/files/detail/vtp_document.h>

// VTK's XML format: https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html

namespace shapespace::internal {
namespace {

std::optional<NumberType> VtpType(std::string_view name) {
  struct Name {
    std::string_view name;
    NumberType type;
  };
  static constexpr Name kNames[] = {
      {"Int8", NumberType::kInt8},     {"UInt8", NumberType::kUint8},
      {"Int16", NumberType::kInt16},   {"UInt16", NumberType::kUint16},
      {"Int32", NumberType::kInt32},   {"UInt32", NumberType::kUint32},
      {"Int64", NumberType::kInt64},   {"UInt64", NumberType::kUint64},
      {"Float32", NumberType::kFloat}, {"Float64", NumberType::kDouble}};
  for (const Name& known : kNames) {
    if (name == known.name) return known.type;
  }
  return std::nullopt;
}

class VtpReader {
 public:
  VtpReader(const std::string& file, const std::string& text, const std::string& field)
      : file_(file), document_(ParseVtp(file, text)), mesh_(file, field), budget_(Budget(text)) {}

  VtkMesh Read() {
    ReadEncoding();
    for (const VtpDocument::Piece& piece : document_.pieces) ReadPiece(piece);
    if (cell_data_ > 0) mesh_.Drop(std::to_string(cell_data_) + " arrays of cell data not kept");
    if (document_.has_field_data) mesh_.Drop("field data not kept");
    return std::move(mesh_);
  }

 private:
  using Array = VtpDocument::Array;
  using Cells = VtkMesh::Cells;

  /// Bytes that all arrays of the file may have: zlib can make a thousandth of them, but does not
  /// of meshes.
  static size_t Budget(const std::string& text) { return 1000000 + 100 * text.size(); }

  [[noreturn]] void Fail(int line, const std::string& what) const { FailAt(file_, line, what); }

  void ReadEncoding() {
    const auto attribute = [&](const char* name) {
      return AttributeOf(document_.attributes, name);
    };
    encoding_.swap = (attribute("byte_order") == "BigEndian") != MachineIsBigEndian();
    encoding_.header_size = attribute("header_type") == "UInt64" ? 8 : 4;
    const std::string_view compressor = attribute("compressor");
    encoding_.compressed = compressor == "vtkZLibDataCompressor";
    if (!compressor.empty() && !encoding_.compressed) {
      Fail(0, "is compressed by " + Quoted(compressor) +
                  ", only zlib is read; in ParaView, choose the compressor ZLib or None");
    }
  }

  void ReadPiece(const VtpDocument::Piece& piece) {
    const Array* points = nullptr;
    for (const Array& array : piece.arrays) {
      if (array.section == "Points" && points == nullptr) points = &array;
    }
    const size_t num_points = Count(piece, "NumberOfPoints");
    std::vector<double> coordinates;
    if (num_points > 0) {
      if (points == nullptr) Fail(piece.line, "a piece has no points" + std::string(kReexport));
      coordinates = Numbers(*points);
    }
    if (coordinates.size() != 3 * num_points) {
      Fail(points->line, NameOf(*points) + "has " + std::to_string(coordinates.size()) +
                             " coordinates; three are expected for each of " +
                             std::to_string(num_points) + " points" + kReexport);
    }
    mesh_.AddPoints(coordinates);
    struct Section {
      const char *count, *name;
      Cells cells;
    };
    for (const Section& section : {Section{"NumberOfVerts", "Verts", Cells::kVertices},
                                   {"NumberOfLines", "Lines", Cells::kLines},
                                   {"NumberOfStrips", "Strips", Cells::kStrips},
                                   {"NumberOfPolys", "Polys", Cells::kPolygons}}) {
      ReadCells(piece, section.name, Count(piece, section.count), section.cells);
    }
    for (const Array& array : piece.arrays) {
      if (array.section == "CellData") ++cell_data_;
      if (array.section == "PointData") ReadPointData(array, piece.texture);
    }
  }

  size_t Count(const VtpDocument::Piece& piece, const char* name) const {
    const std::string_view word = AttributeOf(piece.attributes, name);
    const std::optional<std::int64_t> count = ParseInteger(word.empty() ? "0" : word);
    if (!count || *count < 0 || *count > std::numeric_limits<int>::max()) {
      Fail(piece.line, std::string(name) + " " + Quoted(word) + " is not a count" + kReexport);
    }
    return static_cast<size_t>(*count);
  }

  void ReadCells(const VtpDocument::Piece& piece, const std::string& section, size_t count,
                 Cells kind) {
    if (count == 0) return;
    const auto find = [&](const char* name) -> const Array& {
      for (const Array& array : piece.arrays) {
        if (array.section == section && AttributeOf(array.attributes, "Name") == name) return array;
      }
      Fail(piece.line, section + " have no array " + Quoted(name) + kReexport);
    };
    const Array& offsets = find("offsets");
    const std::vector<double> ends = Numbers(offsets);
    if (ends.size() != count) {
      Fail(offsets.line, NameOf(offsets) + "has " + std::to_string(ends.size()) + " numbers for " +
                             std::to_string(count) + " cells of " + section + kReexport);
    }
    mesh_.AddCells(kind, Numbers(find("connectivity")), ends);
  }

  void ReadPointData(const Array& data, const std::string& texture) {
    VtkMesh::Array array;
    array.name = AttributeOf(data.attributes, "Name");
    array.type = VtpType(AttributeOf(data.attributes, "type")).value_or(NumberType::kDouble);
    array.is_texture = !texture.empty() && array.name == texture;
    const std::string_view components = AttributeOf(data.attributes, "NumberOfComponents");
    const std::optional<std::int64_t> count = ParseInteger(components.empty() ? "1" : components);
    if (!count || *count < 1 || *count > 1000) {
      Fail(data.line, NameOf(data) + Quoted(components) + " is not a number of components");
    }
    array.components = static_cast<int>(*count);
    const VtkMesh::Use use = mesh_.UseOf(array);
    if (use == VtkMesh::Use::kNone) return;
    try {
      mesh_.AddPointData(array, use, Numbers(data));
    } catch (const FileError& error) {
      // The mesh does not need its colours and texture coordinates.
      if (use == VtkMesh::Use::kField) throw;
      mesh_.Drop(std::string(error.what()) + "; not kept");
    }
  }

  // ---- arrays

  static std::string NameOf(const Array& array) {
    return "array " + Quoted(AttributeOf(array.attributes, "Name")) + ": ";
  }

  std::vector<double> Numbers(const Array& array) {
    const std::string_view type_name = AttributeOf(array.attributes, "type");
    const std::optional<NumberType> type = VtpType(type_name);
    if (!type) {
      Fail(array.line,
           NameOf(array) + "its type " + Quoted(type_name) + " is not one of numbers" + kReexport);
    }
    if (AttributeOf(array.attributes, "format") == "ascii") return TextNumbers(array);
    const std::string bytes = Bytes(array);
    const size_t size = Size(*type);
    if (bytes.size() % size != 0) {
      Fail(array.line, NameOf(array) + "its end is inside a number" + kReexport);
    }
    std::vector<double> numbers(bytes.size() / size);
    for (size_t i = 0; i < numbers.size(); ++i) {
      numbers[i] = Decode(bytes.data() + i * size, *type, encoding_.swap);
    }
    return numbers;
  }

  std::vector<double> TextNumbers(const Array& array) const {
    std::vector<double> numbers;
    Lines lines(array.text);
    for (std::string_view line; lines.Next(&line);) {
      for (LineWords words(line); !words.Done();) {
        const std::string_view word = words.Next();
        const std::optional<double> value = ParseDouble(word);
        if (!value) {
          Fail(array.line + lines.Number() - 1, NameOf(array) + NotANumber(word));
        }
        numbers.push_back(*value);
      }
    }
    return numbers;
  }

  std::string Bytes(const Array& array) {
    const std::string_view format = AttributeOf(array.attributes, "format");
    std::string_view encoded = array.text;
    bool base64 = true;
    if (format == "appended") {
      const std::string_view word = AttributeOf(array.attributes, "offset");
      const std::optional<std::int64_t> offset = ParseInteger(word);
      if (!offset || *offset < 0 ||
          *offset > static_cast<std::int64_t>(document_.appended.size())) {
        Fail(array.line,
             NameOf(array) + "its offset " + Quoted(word) + " is not in the file" + kReexport);
      }
      encoded = document_.appended.substr(static_cast<size_t>(*offset));
      base64 = document_.appended_as_base64;
    } else if (format != "binary") {
      Fail(array.line, NameOf(array) + "its format " + Quoted(format) +
                           " is not one of ascii, binary and appended");
    }
    try {
      std::string bytes = DecodeVtpArray(encoded, base64, encoding_, budget_);
      budget_ -= std::min(bytes.size(), budget_);
      return bytes;
    } catch (const FileError& error) {
      Fail(array.line, NameOf(array) + error.what() + kReexport);
    }
  }

  const std::string& file_;
  const VtpDocument document_;
  VtkMesh mesh_;
  VtpEncoding encoding_;
  size_t budget_;  // bytes that further arrays may have
  size_t cell_data_ = 0;
};

}  // namespace

Soup ReadVtp(const std::string& file, const std::string& text) {
  return VtpReader(file, text, "").Read().TakeSoup();
}

Eigen::VectorXd ReadVtpField(const std::string& file, const std::string& text,
                             const std::string& name) {
  return VtpReader(file, text, name).Read().TakeField();
}

}  // namespace shapespace::internal
