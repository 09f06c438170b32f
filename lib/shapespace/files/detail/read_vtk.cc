#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/detail/number_type.h>
#include <shapespace/files/detail/read_formats.h>
#include <shapespace/files/detail/vtk_mesh.h>

// VTK's legacy format: https://docs.vtk.org/en/latest/vtk_file_formats/vtk_legacy_file_format.html

namespace shapespace::internal {
namespace {

constexpr char kSaveAsSurface[] =
    "; in ParaView, apply the filter Extract Surface and save the result as .vtp or .vtk";

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The type of this name; VTK does not distinguish capitals in it. Integers of 64 bits and
/// `vtkIdType` are stored as VTK stores them on systems where its `long` has 64 bits: all but
/// Windows.
std::optional<NumberType> VtkType(std::string_view name) {
  struct Name {
    std::string_view name;
    NumberType type;
  };
  static constexpr Name kNames[] = {{"char", NumberType::kInt8},
                                    {"signed_char", NumberType::kInt8},
                                    {"unsigned_char", NumberType::kUint8},
                                    {"short", NumberType::kInt16},
                                    {"unsigned_short", NumberType::kUint16},
                                    {"int", NumberType::kInt32},
                                    {"unsigned_int", NumberType::kUint32},
                                    {"long", NumberType::kInt64},
                                    {"unsigned_long", NumberType::kUint64},
                                    {"vtktypeint64", NumberType::kInt64},
                                    {"vtktypeuint64", NumberType::kUint64},
                                    {"vtkidtype", NumberType::kInt32},
                                    {"float", NumberType::kFloat},
                                    {"double", NumberType::kDouble}};
  const std::string small = InSmallLetters(name);
  for (const Name& known : kNames) {
    if (small == known.name) return known.type;
  }
  return std::nullopt;
}

/// Names of arrays have blanks and other bytes as %20.
std::string Unescaped(std::string_view word) {
  std::string name;
  for (size_t i = 0; i < word.size(); ++i) {
    int byte = 0;
    const auto [stop, error] =
        i + 2 < word.size() && word[i] == '%'
            ? std::from_chars(word.data() + i + 1, word.data() + i + 3, byte, 16)
            : std::from_chars_result{nullptr, std::errc::invalid_argument};
    if (error == std::errc() && stop == word.data() + i + 3) {
      name += static_cast<char>(byte);
      i += 2;
    } else {
      name += word[i];
    }
  }
  return name;
}

class LegacyVtkReader {
 public:
  LegacyVtkReader(const std::string& file, const std::string& text, const std::string& field,
                  bool little_endian)
      : file_(file), text_(text), mesh_(file, field), little_endian_(little_endian) {}

  VtkMesh Read() {
    ReadHeader();
    for (std::string keyword = Keyword(); !keyword.empty(); keyword = Keyword()) Read(keyword);
    if (!pending_ends_.empty()) Fail("CELLS have no CELL_TYPES" + std::string(kReexport));
    if (cell_data_ > 0) mesh_.Drop(std::to_string(cell_data_) + " arrays of cell data not kept");
    return std::move(mesh_);
  }

  bool IsBinary() const { return binary_; }

  /// Whether the file has lists of cells that fit together in this byte order, and so not in the
  /// other one.
  bool CellsFit() const { return cells_fit_; }

 private:
  using Cells = VtkMesh::Cells;

  /// Lines of a binary file are counted up to its first numbers only.
  [[noreturn]] void Fail(const std::string& what) const {
    FailAt(file_, passed_bytes_ ? 0 : word_line_, what);
  }

  // ---- lines and words

  std::string_view Line() {
    const size_t end = std::min(text_.find('\n', position_), text_.size());
    std::string_view line = std::string_view(text_).substr(position_, end - position_);
    position_ = std::min(end + 1, text_.size());
    word_line_ = line_++;
    while (!line.empty() && IsBlank(line.back())) line.remove_suffix(1);
    return line;
  }

  /// The next word of the file; empty at its end.
  std::string_view Word() {
    for (; position_ < text_.size() && IsBlank(text_[position_]); ++position_) {
      if (text_[position_] == '\n') ++line_;
    }
    const size_t begin = position_;
    word_line_ = line_;
    while (position_ < text_.size() && !IsBlank(text_[position_])) ++position_;
    return std::string_view(text_).substr(begin, position_ - begin);
  }

  /// The next word, in capitals.
  std::string Keyword() {
    std::string word(Word());
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return word;
  }

  /// Whether the next word is this one, which is then passed.
  bool Passes(std::string_view keyword) {
    const size_t position = position_;
    const int line = line_;
    if (Keyword() == keyword) return true;
    position_ = position;
    line_ = line;
    return false;
  }

  /// The next word if it is on the same line; otherwise empty.
  std::string_view WordOfLine() {
    size_t next = position_;
    while (next < text_.size() && IsBlank(text_[next])) {
      if (text_[next++] == '\n') return {};
    }
    return Word();
  }

  size_t Count(const std::string& what) {
    const std::string_view word = Word();
    const std::optional<std::int64_t> count = ParseInteger(word);
    if (!count || *count < 0) {
      Fail("the number of " + what + " " + Quoted(word) + " is not a count" + kReexport);
    }
    return static_cast<size_t>(*count);
  }

  // ---- numbers

  void CheckRoom(size_t count, size_t bytes, const std::string& what) const {
    // The last number of a text need not be followed by a blank.
    const size_t left = text_.size() - position_ + (binary_ ? 0 : 1);
    if (count <= left / (binary_ ? bytes : 2)) return;
    Fail(what + ": " + std::to_string(count) +
         " numbers are promised, which the file has no room for" + kReexport);
  }

  /// In a binary file, numbers begin on the line after the words.
  void BeginNumbers() {
    if (!binary_) return;
    Line();
    passed_bytes_ = true;
  }

  std::vector<double> Numbers(size_t count, NumberType type, const std::string& what) {
    BeginNumbers();
    CheckRoom(count, Size(type), what);
    std::vector<double> numbers(count);
    for (double& number : numbers) {
      if (binary_) {
        number = Decode(text_.data() + position_, type, little_endian_ == MachineIsBigEndian());
        position_ += Size(type);
        continue;
      }
      const std::string_view word = Word();
      if (word.empty()) Fail(what + ": the file ends before its last number" + kReexport);
      const std::optional<double> value = ParseDouble(word);
      // The mesh does not need its data.
      if (!value && !in_data_) Fail(what + ": " + NotANumber(word));
      number = value.value_or(std::numeric_limits<double>::quiet_NaN());
    }
    return numbers;
  }

  /// A product of counts, one of which is at most the size of the file.
  size_t Times(size_t count, size_t components, const std::string& what) const {
    if (components > 0 && count > text_.size() / components * 8 + 8) {
      Fail(what + ": more numbers are promised than the file has bytes" + kReexport);
    }
    return count * components;
  }

  /// The numbers of an array of a type that is named in words; those of bits are passed and empty.
  std::vector<double> NumbersOf(size_t count, std::string_view type, const std::string& what) {
    if (type == "bit") {
      if (!binary_) return Numbers(count, NumberType::kUint8, what);
      Numbers(count / 8 + (count % 8 > 0), NumberType::kUint8, what);
      return {};
    }
    return Numbers(count, TypeOf(type, what), what);
  }

  /// Passes texts: in a text file one a line; in a binary one each with its length in front, whose
  /// first two bits say in how many bytes it is.
  void PassTexts(size_t count, const std::string& what) {
    BeginNumbers();
    if (!binary_) Line();
    for (size_t i = 0; i < count; ++i) {
      const size_t left = text_.size() - position_;
      if (left == 0) Fail(what + ": the file ends before its last text" + kReexport);
      if (!binary_) {
        Line();
        continue;
      }
      constexpr size_t kBytes[] = {8, 4, 2, 1};
      const auto first = static_cast<unsigned char>(text_[position_]);
      const size_t bytes = kBytes[first >> 6];
      std::uint64_t length = first & 63;
      for (size_t k = 1; k < bytes && k < left; ++k) {
        length = length << 8 | static_cast<unsigned char>(text_[position_ + k]);
      }
      if (bytes > left || length > left - bytes) {
        Fail(what + ": text " + std::to_string(i + 1) + " is longer than the file" + kReexport);
      }
      position_ += bytes + length;
    }
  }

  NumberType TypeOf(std::string_view name, const std::string& what) const {
    const std::optional<NumberType> type = VtkType(name);
    if (!type) {
      Fail(what + ": arrays of type " + Quoted(name) +
           " are not read; save the mesh as .vtp, or without this array");
    }
    return *type;
  }

  // ---- parts of the file

  void ReadHeader() {
    constexpr std::string_view kMagic = "# vtk DataFile Version ";
    std::string_view line = Line();
    if (line.substr(0, kMagic.size()) != kMagic) {
      Fail(
          "does not begin with '# vtk DataFile Version'; is this a VTK file of the legacy format?");
    }
    LineWords version(line.substr(kMagic.size()));
    const std::optional<double> number = ParseDouble(version.Next());
    if (!number || !(*number >= 1 && *number < 6)) {
      Fail("the version of the format is not one of 1.0 to 5.1; save the mesh as .vtp");
    }
    has_offsets_ = *number >= 5;
    Line();  // a title
    const std::string format = Keyword();
    if (format != "ASCII" && format != "BINARY") {
      Fail("the third line is neither ASCII nor BINARY" + std::string(kReexport));
    }
    binary_ = format == "BINARY";
  }

  void Read(const std::string& keyword) {
    if (keyword == "DATASET") return ReadDataset();
    if (keyword == "METADATA") {
      Line();
      while (position_ < text_.size() && !Line().empty()) continue;
      return;
    }
    if (keyword == "FIELD") return ReadField();
    if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
      of_points_ = keyword == "POINT_DATA";
      num_data_ = Count(of_points_ ? "points with data" : "cells with data");
      in_data_ = true;
      if (of_points_ && num_data_ != mesh_.NumPiecePoints()) {
        Fail("data of " + std::to_string(num_data_) + " points follow, there are " +
             std::to_string(mesh_.NumPiecePoints()) + kReexport);
      }
      return;
    }
    in_data_ ? ReadAttribute(keyword) : ReadGeometry(keyword);
  }

  void ReadDataset() {
    const std::string kind = Keyword();
    if (kind != "POLYDATA" && kind != "UNSTRUCTURED_GRID") {
      Fail("the data set is of the kind " + Quoted(kind) +
           ", only POLYDATA and UNSTRUCTURED_GRID are read" + kSaveAsSurface);
    }
  }

  void ReadGeometry(const std::string& keyword) {
    if (keyword == "POINTS") {
      if (mesh_.NumPiecePoints() > 0) Fail("POINTS occur twice" + std::string(kReexport));
      const size_t count = Count("points");
      const NumberType type = TypeOf(Word(), "points");
      return mesh_.AddPoints(Numbers(Times(count, 3, "points"), type, "points"));
    }
    struct Kind {
      std::string_view keyword;
      Cells cells;
    };
    for (const Kind& kind : {Kind{"VERTICES", Cells::kVertices},
                             {"LINES", Cells::kLines},
                             {"POLYGONS", Cells::kPolygons},
                             {"TRIANGLE_STRIPS", Cells::kStrips}}) {
      if (keyword != kind.keyword) continue;
      ReadCells(keyword);
      mesh_.AddCells(kind.cells, connectivity_, ends_);
      return;
    }
    if (keyword == "CELLS") {
      ReadCells(keyword);
      pending_ends_ = ends_;
      return;
    }
    if (keyword == "CELL_TYPES") return ReadCellTypes();
    Fail(Quoted(keyword) + " is not a keyword of a mesh" + kReexport);
  }

  /// Before version 5, each cell is its number of points and the points. Since then there are two
  /// arrays: where cells begin, with the end of the last one, and the points.
  void ReadCells(const std::string& keyword) {
    const size_t count = Count("cells"), size = Count("numbers of the cells");
    connectivity_.clear();
    ends_.clear();
    if (has_offsets_) {
      if (count == 0) return;
      ends_ = ReadPart("OFFSETS", count, keyword);
      const bool in_bytes = part_has_bytes_;
      if (ends_.front() != 0) Fail(keyword + ": the first offset is not 0" + kReexport);
      ends_.erase(ends_.begin());
      connectivity_ = ReadPart("CONNECTIVITY", size, keyword);
      // Bytes are the same in both orders.
      cells_fit_ = cells_fit_ ||
                   (!in_bytes && !ends_.empty() && std::is_sorted(ends_.begin(), ends_.end()) &&
                    ends_.back() == static_cast<double>(size) && size > 0);
      return;
    }
    const std::vector<double> numbers = Numbers(size, NumberType::kInt32, keyword);
    size_t at = 0;
    for (size_t i = 0; i < count; ++i) {
      const size_t left = at < size ? size - at - 1 : 0;
      if (at >= size || !(numbers[at] >= 0) || numbers[at] > static_cast<double>(left)) {
        Fail(keyword + ": cell " + std::to_string(i + 1) +
             " has more points than the list of cells has room for" + kReexport);
      }
      const auto points = static_cast<size_t>(numbers[at]);
      const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(at) + 1;
      connectivity_.insert(connectivity_.end(), begin, begin + static_cast<std::ptrdiff_t>(points));
      ends_.push_back(static_cast<double>(connectivity_.size()));
      at += 1 + points;
    }
    if (at != size) {
      Fail(keyword + ": the list of cells is longer than its " + std::to_string(count) + " cells" +
           kReexport);
    }
    cells_fit_ = cells_fit_ || size > 0;
  }

  std::vector<double> ReadPart(const std::string& part, size_t count, const std::string& keyword) {
    if (!Passes(part)) Fail(keyword + " is not followed by " + part + kReexport);
    const NumberType type = TypeOf(Word(), keyword);
    part_has_bytes_ = Size(type) == 1;
    return Numbers(count, type, keyword + ", " + part);
  }

  void ReadCellTypes() {
    const size_t count = Count("cell types");
    if (count != pending_ends_.size()) {
      Fail(std::to_string(count) + " cell types follow, there are " +
           std::to_string(pending_ends_.size()) + " cells" + kReexport);
    }
    const std::vector<double> types = Numbers(count, NumberType::kInt32, "cell types");
    std::vector<Cells> kinds;
    for (size_t i = 0; i < count; ++i) {
      kinds.push_back(KindOf(types[i], i));
      if (types[i] == kPixel) SwapLastPoints(i);
    }
    mesh_.AddCells(kinds, connectivity_, pending_ends_);
    pending_ends_.clear();
  }

  static constexpr int kPixel = 8;

  Cells KindOf(double type, size_t cell) const {
    switch (type >= 1 && type <= 255 ? static_cast<int>(type) : 0) {
      case 1:
      case 2:
        return Cells::kVertices;
      case 3:
      case 4:
        return Cells::kLines;
      case 5:
      case 7:
      case kPixel:
      case 9:
        return Cells::kPolygons;
      case 6:
        return Cells::kStrips;
      default:
        const std::string number = std::to_string(type);
        Fail("cell " + std::to_string(cell + 1) + " is of VTK's type " +
             number.substr(0, number.find('.')) + (type >= 10 && type <= 14 ? ", a volume" : "") +
             "; only points, lines, triangles, quadrilaterals, polygons and strips are read" +
             kSaveAsSurface);
    }
  }

  /// The points of a pixel are in the order of a raster; those of a polygon go round it.
  void SwapLastPoints(size_t cell) {
    const double begin = cell > 0 ? pending_ends_[cell - 1] : 0, end = pending_ends_[cell];
    if (end != begin + 4 || !(begin >= 0) || end > static_cast<double>(connectivity_.size())) {
      Fail("cell " + std::to_string(cell + 1) + ": a pixel needs four points" + kReexport);
    }
    const auto last = static_cast<size_t>(end) - 1;
    std::swap(connectivity_[last - 1], connectivity_[last]);
  }

  // ---- data of points and cells

  void ReadAttribute(const std::string& keyword) {
    if (keyword == "LOOKUP_TABLE") {
      Word();
      const size_t colours = Count("colours");
      Numbers(Times(colours, 4, "lookup table"), binary_ ? NumberType::kUint8 : NumberType::kFloat,
              "lookup table");
      return;
    }
    VtkMesh::Array array;
    array.name = Unescaped(Word());
    const std::string what = "data " + Quoted(array.name);
    if (keyword == "COLOR_SCALARS") {
      array.components = Components(Word(), what);
      array.type = binary_ ? NumberType::kUint8 : NumberType::kFloat;
      array.is_colour = true;
      return Add(array, Numbers(Times(num_data_, array.components, what), array.type, what));
    }
    if (keyword == "TEXTURE_COORDINATES") {
      array.components = Components(Word(), what);
      array.is_texture = true;
    } else if (keyword == "VECTORS" || keyword == "NORMALS") {
      array.components = 3;
    } else if (keyword == "TENSORS" || keyword == "TENSORS6") {
      array.components = keyword == "TENSORS" ? 9 : 6;
    } else if (keyword != "SCALARS" && keyword != "GLOBAL_IDS" && keyword != "PEDIGREE_IDS" &&
               keyword != "EDGE_FLAGS") {
      Fail(Quoted(keyword) + " is not a keyword of data" + kReexport);
    }
    const std::string type = InSmallLetters(Word());
    if (keyword == "SCALARS") {
      const std::string_view components = WordOfLine();
      if (!components.empty()) array.components = Components(components, what);
      if (Passes("LOOKUP_TABLE")) Word();
    }
    ReadAttribute(array, type, num_data_, what);
  }

  int Components(std::string_view word, const std::string& what) const {
    const std::optional<std::int64_t> count = ParseInteger(word);
    if (!count || *count < 1 || *count > 1000) {
      Fail(what + ": " + Quoted(word) + " is not a number of components" + kReexport);
    }
    return static_cast<int>(*count);
  }

  void ReadAttribute(VtkMesh::Array array, const std::string& type, size_t tuples,
                     const std::string& what) {
    const size_t count = Times(tuples, array.components, what);
    if (type == "string" || type == "utf8_string") {
      PassTexts(count, what);
      if (in_data_ && of_points_) mesh_.UseOf(array);
      return;
    }
    array.type = VtkType(type).value_or(NumberType::kDouble);
    const std::vector<double> numbers = NumbersOf(count, type, what);
    if (numbers.size() == count) Add(array, numbers);
  }

  void Add(const VtkMesh::Array& array, const std::vector<double>& numbers) {
    if (!in_data_) return;
    if (!of_points_) {
      ++cell_data_;
      return;
    }
    mesh_.AddPointData(array, mesh_.UseOf(array), numbers);
  }

  void ReadField() {
    Word();
    const size_t arrays = Count("arrays of the field");
    for (size_t i = 0; i < arrays; ++i) {
      VtkMesh::Array array;
      array.name = Unescaped(Word());
      if (array.name.empty()) Fail("the file ends inside a field" + std::string(kReexport));
      // Arrays may be followed by a description.
      if (array.name == "METADATA") {
        Read(array.name);
        array.name = Unescaped(Word());
      }
      const std::string what = "array " + Quoted(array.name);
      array.components = Components(Word(), what);
      const size_t tuples = Count("tuples");
      const std::string type = InSmallLetters(Word());
      ReadAttribute(array, type, tuples, what);
    }
  }

  const std::string& file_;
  const std::string& text_;
  VtkMesh mesh_;
  size_t position_ = 0;
  int line_ = 1;       // of the position
  int word_line_ = 1;  // of the last word or line that was read
  const bool little_endian_;
  bool binary_ = false, passed_bytes_ = false;
  bool cells_fit_ = false, part_has_bytes_ = false;
  bool has_offsets_ = false;                  // version 5
  std::vector<double> connectivity_, ends_;   // of the last cells
  std::vector<double> pending_ends_;          // of CELLS, until their types are known
  bool in_data_ = false, of_points_ = false;  // after POINT_DATA or CELL_DATA
  size_t num_data_ = 0;                       // of these points or cells
  size_t cell_data_ = 0;
};

/// Binary files are big-endian, but some programs write the numbers as their machine has them.
VtkMesh ReadEitherOrder(const std::string& file, const std::string& text,
                        const std::string& field) {
  constexpr char kLittleEndian[] =
      "the numbers are little-endian, which VTK's own reader takes for other numbers";
  LegacyVtkReader as_defined(file, text, field, /*little_endian=*/false);
  try {
    return as_defined.Read();
  } catch (const FileError&) {
    if (!as_defined.IsBinary() || as_defined.CellsFit()) throw;
    LegacyVtkReader other(file, text, field, /*little_endian=*/true);
    std::string error;
    try {
      VtkMesh mesh = other.Read();
      mesh.Drop(kLittleEndian);
      if (other.CellsFit()) return mesh;
    } catch (const FileError& exception) {
      error = exception.what();
    }
    if (other.CellsFit()) throw FileError(error + " (" + kLittleEndian + ")");
    throw;
  }
}

}  // namespace

Soup ReadVtk(const std::string& file, const std::string& text) {
  return ReadEitherOrder(file, text, "").TakeSoup();
}

Eigen::VectorXd ReadVtkField(const std::string& file, const std::string& text,
                             const std::string& name) {
  return ReadEitherOrder(file, text, name).TakeField();
}

}  // namespace shapespace::internal
