#include <shapespace/files/detail/vtk_mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <shapespace/base/internal/text.h>

namespace shapespace::internal {
namespace {

constexpr size_t kMaxCount = std::numeric_limits<int>::max();

const char* NameOf(VtkMesh::Cells kind) {
  switch (kind) {
    case VtkMesh::Cells::kVertices:
      return "vertex cell";
    case VtkMesh::Cells::kLines:
      return "line";
    case VtkMesh::Cells::kPolygons:
      return "polygon";
    case VtkMesh::Cells::kStrips:
      break;
  }
  return "triangle strip";
}

}  // namespace

void VtkMesh::Fail(const std::string& what) const { FailAt(soup_.file, 0, what); }

void VtkMesh::AddPoints(const std::vector<double>& numbers) {
  piece_begin_ = points_.size() / 3;
  if (numbers.size() % 3 != 0) {
    Fail("the points have " + std::to_string(numbers.size()) +
         " coordinates, which are not three for each" + kReexport);
  }
  if (points_.size() + numbers.size() > kMaxCount) Fail("has too many points to be read");
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (std::isfinite(numbers[i])) continue;
    Fail("vertex " + std::to_string(piece_begin_ + i / 3 + 1) + ": coordinate " + "xyz"[i % 3] +
         " is not a finite number" + kReexport);
  }
  points_.insert(points_.end(), numbers.begin(), numbers.end());
}

void VtkMesh::AddCells(Cells kind, const std::vector<double>& connectivity,
                       const std::vector<double>& ends) {
  AddCells(std::vector<Cells>(ends.size(), kind), connectivity, ends);
}

void VtkMesh::AddCells(const std::vector<Cells>& kinds, const std::vector<double>& connectivity,
                       const std::vector<double>& ends) {
  const auto size = static_cast<double>(connectivity.size());
  double begin = 0;
  for (size_t i = 0; i < ends.size(); ++i) {
    if (!(ends[i] >= begin) || ends[i] > size || ends[i] != std::floor(ends[i])) {
      Fail(std::string(NameOf(kinds[i])) + " " + std::to_string(i + 1) +
           ": where its points end in the connectivity is not a number from " +
           std::to_string(static_cast<size_t>(begin)) + " to " +
           std::to_string(connectivity.size()) + kReexport);
    }
    AddCell(kinds[i], connectivity.data() + static_cast<size_t>(begin),
            connectivity.data() + static_cast<size_t>(ends[i]));
    begin = ends[i];
  }
  if (begin != size) {
    Fail("the cells have " + std::to_string(static_cast<size_t>(begin)) +
         " points, the connectivity has " + std::to_string(connectivity.size()) + kReexport);
  }
}

void VtkMesh::AddCell(Cells kind, const double* begin, const double* end) {
  size_t number = 0;
  std::ptrdiff_t least = 1;
  switch (kind) {
    case Cells::kVertices:
      number = ++vertex_cells_;
      break;
    case Cells::kLines:
      number = ++lines_, least = 2;
      break;
    case Cells::kPolygons:
      number = soup_.NumPolygons() + 1, least = 3;
      break;
    case Cells::kStrips:
      number = ++strips_, least = 3;
      break;
  }
  if (end - begin < least) {
    Fail(std::string(NameOf(kind)) + " " + std::to_string(number) + ": " +
         std::to_string(end - begin) + " points, it needs " + std::to_string(least) + kReexport);
  }
  std::vector<int> points;
  for (const double* p = begin; p < end; ++p) points.push_back(Index(*p, NameOf(kind), number));
  // A strip has up to three corners for each of its points.
  if (soup_.corners.size() + 3 * points.size() > kMaxCount) Fail("has too many cells to be read");
  const auto add_polygon = [&](auto first, auto last) {
    soup_.corners.insert(soup_.corners.end(), first, last);
    soup_.polygon_begin.push_back(static_cast<int>(soup_.corners.size()));
  };
  if (kind == Cells::kPolygons) add_polygon(points.begin(), points.end());
  for (size_t i = 1; kind == Cells::kLines && i < points.size(); ++i) {
    soup_.segments.emplace_back(points[i - 1], points[i]);
  }
  // The triangles of a strip have alternating orientation.
  for (size_t i = 2; kind == Cells::kStrips && i < points.size(); ++i) {
    const int odd = i % 2 == 1;
    const int corners[] = {points[i - 2 + odd], points[i - 1 - odd], points[i]};
    add_polygon(corners, corners + 3);
  }
}

int VtkMesh::Index(double number, const char* kind, size_t cell) const {
  const size_t count = NumPiecePoints();
  if (!(number >= 0) || number >= static_cast<double>(count) || number != std::floor(number)) {
    Fail(std::string(kind) + " " + std::to_string(cell) + ": a point's index is not one of 0 to " +
         std::to_string(static_cast<std::int64_t>(count) - 1) + kReexport);
  }
  return static_cast<int>(piece_begin_ + static_cast<size_t>(number));
}

VtkMesh::Use VtkMesh::UseOf(const Array& array) {
  if (!field_name_.empty()) {
    if (array.name != field_name_) return Use::kNone;
    if (array.components != 1) {
      Fail("the point data " + Quoted(field_name_) + " has " + std::to_string(array.components) +
           " components; name data with one number a point");
    }
    return Use::kField;
  }
  // VTK's own rule: bytes with three or four components are colours.
  const bool is_colour =
      array.is_colour || (array.type == NumberType::kUint8 && array.components >= 3);
  const bool fits = channels_ == 0 || channels_ == array.components;
  if (is_colour && array.components <= 4 && array.components >= 3 && fits &&
      colours_.size() == channels_ * piece_begin_) {
    return Use::kColours;
  }
  if (array.is_texture && array.components == 2 && texture_.size() == 2 * piece_begin_) {
    return Use::kTexture;
  }
  if (not_kept_names_.insert(array.name).second) not_kept_.push_back(array.name);
  return Use::kNone;
}

void VtkMesh::AddPointData(const Array& array, Use use, const std::vector<double>& numbers) {
  if (use == Use::kNone) return;
  if (numbers.size() != NumPiecePoints() * array.components) {
    const std::string what = "the point data " + Quoted(array.name) + " has " +
                             std::to_string(numbers.size()) + " numbers; " +
                             std::to_string(NumPiecePoints()) + " points of " +
                             std::to_string(array.components) + " are expected";
    if (use == Use::kField) Fail(what + kReexport);
    return Drop(what + "; not kept");
  }
  if (use == Use::kColours) {
    channels_ = array.components;
    full_colour_ = IsInteger(array.type) ? 255 : 1;
  }
  std::vector<double>& all = use == Use::kColours   ? colours_
                             : use == Use::kTexture ? texture_
                                                    : field_;
  all.insert(all.end(), numbers.begin(), numbers.end());
}

void VtkMesh::TakeColours() {
  const size_t vertices = points_.size() / 3;
  if (colours_.empty()) return;
  const auto outside = [&](double number) { return !(number >= 0 && number <= full_colour_); };
  if (colours_.size() != channels_ * vertices) {
    Drop("vertex colours, which not all pieces have, not kept");
  } else if (std::any_of(colours_.begin(), colours_.end(), outside)) {
    Drop(std::to_string(vertices) +
         " vertex colours (some number of them is not in 0 .. 1) not kept");
  } else {
    soup_.appearance.vertex_colours =
        Eigen::Map<const Eigen::MatrixXd>(colours_.data(), channels_,
                                          static_cast<Eigen::Index>(vertices)) /
        full_colour_;
  }
}

Soup VtkMesh::TakeSoup() {
  const auto vertices = static_cast<Eigen::Index>(points_.size() / 3);
  if (vertices == 0) Fail("there is no point in it" + std::string(kReexport));
  soup_.vertices = Eigen::Map<const Shape>(points_.data(), 3, vertices);
  TakeColours();
  if (!texture_.empty() && texture_.size() == 2 * static_cast<size_t>(vertices)) {
    const auto finite = [](double number) { return std::isfinite(number); };
    if (std::all_of(texture_.begin(), texture_.end(), finite) && !soup_.corners.empty()) {
      soup_.appearance.texture_coordinates =
          Eigen::Map<const Eigen::Matrix2Xd>(texture_.data(), 2, vertices);
      soup_.appearance.corner_texture = soup_.corners;
    } else {
      Drop("texture coordinates that are not finite, or that no polygon has, not kept");
    }
  } else if (!texture_.empty()) {
    Drop("texture coordinates, which not all pieces have, not kept");
  }
  if (vertex_cells_ > 0) Drop(std::to_string(vertex_cells_) + " vertex cells not kept");
  constexpr size_t kMaxNames = 20;
  std::string names;
  for (size_t i = 0; i < std::min(not_kept_.size(), kMaxNames); ++i) {
    names += (i == 0 ? "" : ", ") + not_kept_[i];
  }
  if (not_kept_.size() > kMaxNames) {
    names += " and " + std::to_string(not_kept_.size() - kMaxNames) + " more";
  }
  if (!names.empty()) Drop("point data not kept: " + names);
  return std::move(soup_);
}

Eigen::VectorXd VtkMesh::TakeField() {
  if (field_.empty()) Fail("no point data has the name " + Quoted(field_name_));
  if (field_.size() != points_.size() / 3) {
    Fail("the point data " + Quoted(field_name_) + " is not that of all pieces");
  }
  return Eigen::Map<const Eigen::VectorXd>(field_.data(), static_cast<Eigen::Index>(field_.size()));
}

}  // namespace shapespace::internal
